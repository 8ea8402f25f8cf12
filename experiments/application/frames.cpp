#include "experiments/application/frames.h"

#include <cmath>

namespace airlight::experiments {

FrameSteps frame_steps(const scene::FlowProblem& problem, const scene::Solver& solver,
                       const scene::Settings& settings) {
  const int steps = solver.steps_per_frame(problem, settings);
  return {int(std::lround(problem.duration * problem.frame_rate)) + 1, steps, 1 / (problem.frame_rate * steps)};
}

void to_next_frame(scene::Flow& flow, const FrameSteps& frame, const std::function<void(double share)>& after_step) {
  for (int step = 0; step < frame.steps; ++step) {
    flow.step(frame.dt);
    after_step(double(step + 1) / frame.steps);
  }
}

std::vector<std::pair<std::string, double>> history_of(double time, const scene::Totals& t) {
  return {{"time", time},
          {"energy", t.energy},
          {"enstrophy", t.enstrophy},
          {"mass", t.mass},
          {"density_least", t.density_least},
          {"density_greatest", t.density_greatest},
          {"greatest_speed", t.greatest_speed},
          {"divergence", t.divergence},
          {"cfl", t.cfl},
          {"center_x", t.center_of_mass[0]},
          {"center_y", t.center_of_mass[1]},
          {"center_z", t.center_of_mass[2]}};
}

}  // namespace airlight::experiments
