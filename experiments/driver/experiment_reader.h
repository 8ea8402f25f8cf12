// Reads an experiment's file: its rows (read_experiment.cpp), then what they are shown and judged by (read_judgements.cpp).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/driver/kind.h"
#include "scene/load/parse_toml.h"

namespace airlight::experiments {

class ExperimentReader {
 public:
  // Throws Error, with file, line and column, where the file is not there or no TOML.
  ExperimentReader(const Folders&, const std::string& id, const std::string& profile);
  Experiment read();

 private:
  using TableReader = scene::load::TableReader;

  // Scenes and methods of the experiment that `like` names, beside those of this file.
  void take_over(const TableReader& top);
  // Replaces the method's renderer by its twin on the device.
  void to_device(toml::table& method, const std::string& name, const TableReader& reader) const;

  const ExperimentKind& kind() const { return *experiment_.kind; }
  std::string position(const std::string& key) const;
  // The tables of [[key]], each with its reader.
  std::vector<std::pair<const toml::table*, TableReader>> lists(const TableReader& top, const std::string& key) const;
  static std::vector<std::pair<const toml::table*, TableReader>> lists(const toml::table& in, const TableReader&,
                                                                       const std::string& key);
  bool in_profile(const toml::table& table, const TableReader& reader) const;
  void profile(const TableReader& top, Pairs& scene_overrides, Pairs& reference_settings);
  void check_component(const TableReader& reader, const std::string& name, const Pairs& given) const;
  void reference(const TableReader& top, const Pairs& finer);
  void read_reference(const TableReader&, const toml::table&, const Pairs& finer, ReferenceCase&) const;
  void scenes(const TableReader& top, const Pairs& of_profile);
  void methods(const TableReader& top);
  // A row of a sweep goes without the settings that are not read beside its value, where another row reads them: a rule of upsampling in
  // the row that samples every pixel.
  void leave_out_unread(const MethodCase& method, std::vector<MethodCase>& cases) const;

  // read_judgements.cpp
  void plots(const TableReader& top);
  // Each row, picture and plot has a name of its own: one would overwrite the other, and nobody could tell them apart.
  void names_apart() const;
  // A name that gates and the like refer to must exist in some profile; here: in this file.
  void known(const TableReader& reader, const std::string& key, const std::string& value,
             const std::string& list) const;
  // A gate must have a row to judge, and each of its rows a figure.
  void has_figures(const TableReader& reader, const GateCase& gate) const;
  void checks(const TableReader& top);
  // Whose speed-up is expected: the table has it, with its interval.
  std::string baseline_of(const TableReader& reader, const ExpectedCase& e) const;
  void check_summary(const TableReader& top) const;
  // [conclusion] and verdicts of [[claim]], for table.md; [[erratum]] is only checked. scripts/figures judges the conditions.
  void claims(const TableReader& top);

  Folders folders_;
  std::string file_;
  toml::table toml_;
  Experiment experiment_;
};

}  // namespace airlight::experiments
