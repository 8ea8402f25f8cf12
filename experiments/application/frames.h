// A flow from frame to frame, and the sums over the box that its history keeps of each.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/flow/flow.h"

namespace airlight::experiments {

struct FrameSteps {
  int frames = 1;  // the start included
  int steps = 1;   // from one to the next
  double dt = 1;   // [s]
};
FrameSteps frame_steps(const scene::FlowProblem&, const scene::Solver&, const scene::Settings&);

// To the next frame; `after_step` gets the share of it that is done.
void to_next_frame(scene::Flow&, const FrameSteps&, const std::function<void(double share)>& after_step);

// Name and value of each column of a history: time, energy, enstrophy, mass, ...
std::vector<std::pair<std::string, double>> history_of(double time, const scene::Totals&);

}  // namespace airlight::experiments
