// Rows of kind "sequence": all pictures of a sequence, each judged against its own reference, and what changes from one to the next against
// what truly does.
#pragma once
#include <vector>

#include "experiments/driver/images.h"

namespace airlight::experiments {

class SequenceImages final : public Images {
 public:
  std::string name() const override { return "sequence"; }
  std::vector<std::string> keys() const override { return {"reference", "layer"}; }
  void read(const TableReader& top, Experiment&) const override;
  std::vector<std::string> scene_keys() const override { return {"frames"}; }
  void read_scene(const TableReader&, SceneCase&) const override;
  std::vector<std::string> method_keys() const override { return {"layer", "convert", "anew"}; }
  void read_method(const TableReader&, const Experiment&, MethodCase&) const override;
  void check_metrics(Experiment&, const std::string& position) const override;
  // Not those of single images. NOLINTNEXTLINE(bugprone-parent-virtual-call)
  std::vector<std::string> times() const override { return ExperimentKind::times(); }
  void check(const Experiment&, const RunOptions&) const override;
  Outcome run(Experiment, const RunOptions&) const override;
  bool times_rows() const override { return false; }
  std::vector<RowColumn> time_columns() const override;
  std::vector<RowColumn> preparation_columns() const override;
  std::string conditions() const override;
};

// The pictures below each other, as one film of the layers that all of them have.
scene::Film stacked(const std::vector<scene::Film>&);

// Differences between each picture and the previous one, in the layer and its batches, stacked
// vertically. Throws Error for fewer than two.
scene::Film changes(const std::vector<scene::Film>&, const std::string& layer);

// Size of a film's changes over its own, of noisy ones without their noise: 0 where nothing moves.
double change(const std::vector<scene::Film>&, const std::string& layer);

}  // namespace airlight::experiments
