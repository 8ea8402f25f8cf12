// A kind of experiment: what makes its rows, what its file may say, how its tables show a row. A new kind is one class and its name in
// all_kinds().
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"
#include "experiments/driver/run.h"
#include "scene/base/component.h"
#include "scene/load/table_reader.h"

namespace airlight::experiments {

struct RowColumn {
  std::string head;
  std::function<std::string(const Row&)> text;
};

class ExperimentKind {
 public:
  using TableReader = scene::load::TableReader;
  virtual ~ExperimentKind() = default;

  // The file. Functions that take a `position` throw Error, which begins with it: file:line:column.
  virtual std::string name() const = 0;
  virtual std::string component_key() const = 0;  // that names what makes a row: "renderer"
  virtual const scene::Component& find_component(const std::string& name, const std::string& position) const = 0;
  virtual std::vector<std::string> keys() const { return {}; }  // beside those of every kind
  virtual void read(const TableReader&, Experiment&) const {}
  virtual std::vector<std::string> scene_keys() const { return {}; }
  virtual void read_scene(const TableReader&, SceneCase&) const {}
  virtual std::vector<std::string> method_keys() const { return {}; }
  virtual void read_method(const TableReader&, const Experiment&, MethodCase&) const {}
  virtual void check_metrics(Experiment&, const std::string& position) const = 0;  // may add some that belong to them
  virtual bool needs_reference(const std::string&, const std::string&) const { return false; }  // metric, position
  virtual bool needs_scene() const { return true; }
  virtual bool draws_pictures() const { return false; }
  // Names of a row's possible times.
  virtual std::vector<std::string> times() const { return {"seconds", "prepare_seconds", "total_seconds"}; }

  // Loads every scene, and tries what check_experiment (run.h) says. Throws Error.
  virtual void check(const Experiment&, const RunOptions&) const = 0;
  virtual Outcome run(Experiment, const RunOptions&) const = 0;
  virtual bool times_rows() const { return true; }  // after they are made, in turns
  // Does the figure depend on how fast the machine is, as times do?
  virtual bool is_speed(const Row&, const std::string&) const { return false; }

  // The tables, where any row is timed.
  virtual std::vector<RowColumn> time_columns() const = 0;
  virtual std::vector<RowColumn> preparation_columns() const { return {}; }  // those that no row has are left out
  virtual std::string conditions() const = 0;                                // how figures and times were taken, a line
};

const std::vector<const ExperimentKind*>& all_kinds();

// Throws Error for a name that no kind has.
const ExperimentKind& find_kind(const std::string& name);

}  // namespace airlight::experiments
