// Rows of kind "flow": what a solver makes of a problem, at named times.
#pragma once
#include "experiments/driver/kind.h"

namespace airlight::experiments {

class Flows : public ExperimentKind {
 public:
  std::string name() const override { return "flow"; }
  std::string component_key() const override { return "solver"; }
  const scene::Component& find_component(const std::string& name, const std::string& position) const override;
  std::vector<std::string> keys() const override { return {"stages", "reference", "orders"}; }
  void read(const TableReader& top, Experiment&) const override;
  void check_metrics(Experiment&, const std::string& position) const override;
  bool needs_reference(const std::string& metric, const std::string& position) const override;
  std::vector<std::string> times() const override;
  // Loads every problem; the reference must solve each, and the times of the metrics must be those of frames.
  void check(const Experiment&, const RunOptions&) const override;
  Outcome run(Experiment, const RunOptions&) const override;
  std::vector<RowColumn> time_columns() const override;
  std::string conditions() const override;
};

}  // namespace airlight::experiments
