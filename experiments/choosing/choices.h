// Rows of kind "choices": how good what `airlight choose` takes first is, over scenes and random variations of them.
#pragma once
#include "experiments/driver/numbers.h"

namespace airlight::experiments {

// A [[method]] is a question: a time, and what moves. A row of a scene has how often the first choice was good, over the scene and its
// variations; the row of "all scenes", over all rows.
class Choices : public Numbers {
 public:
  std::string name() const override { return "choices"; }
  std::string component_key() const override { return "question"; }
  const scene::Component& find_component(const std::string& name, const std::string& position) const override;
  void check_metrics(Experiment&, const std::string& position) const override;  // adds the scene "all scenes"
  bool needs_scene() const override { return true; }
  void check(const Experiment&, const RunOptions&) const override;
  Outcome run(Experiment, const RunOptions&) const override;
  bool is_speed(const Row&, const std::string&) const override { return true; }
  std::string conditions() const override;
};

// Whose rows `airlight choose` tries.
inline constexpr const char* rows_of_all_orders = "common/all_orders";
inline constexpr const char* rows_of_one_order = "common/one_order";

}  // namespace airlight::experiments
