// Rows of kind "numbers": what a probe finds.
#pragma once
#include "experiments/driver/kind.h"

namespace airlight::experiments {

class Numbers : public ExperimentKind {
 public:
  std::string name() const override { return "numbers"; }
  std::string component_key() const override { return "probe"; }
  const scene::Component& find_component(const std::string& name, const std::string& position) const override;
  void check_metrics(Experiment&, const std::string& position) const override;  // figures of the probes
  bool needs_scene() const override { return false; }
  void check(const Experiment&, const RunOptions&) const override;
  Outcome run(Experiment, const RunOptions&) const override;
  bool times_rows() const override { return false; }
  bool is_speed(const Row&, const std::string& metric) const override;
  std::vector<RowColumn> time_columns() const override;
  std::string conditions() const override;
};

}  // namespace airlight::experiments
