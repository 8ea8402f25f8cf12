// Rows of kind "images": a renderer's film judged against a reference's.
#pragma once
#include "experiments/driver/kind.h"

namespace airlight::experiments {

class Images : public ExperimentKind {
 public:
  std::string name() const override { return "images"; }
  std::string component_key() const override { return "renderer"; }
  const scene::Component& find_component(const std::string& name, const std::string& position) const override;
  std::vector<std::string> keys() const override { return {"stages", "reference", "layer", "moves", "left_out"}; }
  void read(const TableReader& top, Experiment&) const override;
  std::vector<std::string> method_keys() const override {
    return {"layer", "picture_only", "count_noise", "moving", "convert"};
  }
  void read_method(const TableReader&, const Experiment&, MethodCase&) const override;
  // Adds root mean squares, which the publications print, beside relative errors.
  void check_metrics(Experiment&, const std::string& position) const override;
  bool needs_reference(const std::string&, const std::string&) const override { return true; }
  std::vector<std::string> times() const override;
  bool draws_pictures() const override { return true; }
  void check(const Experiment&, const RunOptions&) const override;
  Outcome run(Experiment, const RunOptions&) const override;
  std::vector<RowColumn> time_columns() const override;
  std::vector<RowColumn> preparation_columns() const override;
  std::string conditions() const override;
};

class RowKeeper;
// Columns of the sequences that scenes show, for plots.
void add_histories(RowKeeper&, const RunOptions&);

}  // namespace airlight::experiments
