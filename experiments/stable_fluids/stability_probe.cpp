#include <fmt/format.h>

#include <cmath>

#include "experiments/stable_fluids/probes.h"
#include "experiments/stable_fluids/stages.h"
#include "reference/stable_fluids/stable_fluids.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

using stable_fluids::StableFluids;

// A closed box of 1 m, stirred by four balls that push, each its own way.
std::shared_ptr<scene::FlowProblem> closed_box(int dimensions, double viscosity) {
  auto problem = std::make_shared<scene::FlowProblem>(unit_cube(scene::Side::Kind::no_slip));
  problem->dimensions = dimensions;
  if (dimensions == 2) problem->box.hi[2] = 0;
  problem->viscosity = viscosity;
  return problem;
}

constexpr double stirring = 1;  // [s]

std::shared_ptr<scene::FlowProblem> stirred_box(int dimensions) {
  auto problem = closed_box(dimensions, 0);
  const double z = dimensions == 2 ? 0 : 0.5, up = dimensions == 2 ? 0 : 3;
  problem->pushes = {{scene::Sphere{{0.3, 0.3, z}, 0.2}, {0, stirring}, {8, 3, up}, 0},
                     {scene::Sphere{{0.7, 0.35, 0.6 * z}, 0.15}, {0, stirring}, {-4, 9, -up}, 0},
                     {scene::Sphere{{0.65, 0.7, 1.4 * z}, 0.2}, {0, stirring}, {-9, -2, up}, 0},
                     {scene::Sphere{{0.25, 0.75, z}, 0.12}, {0, stirring}, {2, -9, -2 * up}, 0}};
  return problem;
}

struct Growth {
  double energy = 0, speed = 0;  // the greatest there is after a step, over that at the beginning; infinite: not finite
};

class Stirred {
 public:
  Stirred(const scene::Settings& s, std::map<std::string, std::string> of_solver)
      : dimensions_(int(s.integer("dimensions"))), n_(int(s.integer("n"))), steps_(int(s.integer("steps"))) {
    const auto flow =
        started(stirred_box(dimensions_), {{"n", std::to_string(n_)}, {"precision", s.text("precision")}});
    const int steps = 8 * n_;
    for (int i = 0; i < steps; ++i) flow->step(stirring / steps);
    state_ = flow->state();
    const scene::Totals totals = flow->totals();
    energy_ = totals.energy;
    speed_ = totals.greatest_speed;
    of_solver_ = std::move(of_solver);
    of_solver_["n"] = std::to_string(n_);
    of_solver_["precision"] = s.text("precision");
  }
  double speed() const { return speed_; }

  // Without what stirred it.
  Growth growth(double cfl, double viscosity) const {
    const auto flow = started(closed_box(dimensions_, viscosity), of_solver_);
    flow->restore(state_);
    Growth g;
    try {
      for (int i = 0; i < steps_; ++i) {
        flow->step(cfl / (n_ * speed_));
        const scene::Totals totals = flow->totals();
        if (!std::isfinite(totals.energy)) return {infinity, infinity};
        g.energy = std::max(g.energy, totals.energy / energy_);
        g.speed = std::max(g.speed, totals.greatest_speed / speed_);
      }
    } catch (const Error&) {  // it tells of numbers that are not finite
      return {infinity, infinity};
    }
    return g;
  }

 private:
  static std::unique_ptr<scene::Flow> started(std::shared_ptr<scene::FlowProblem> problem,
                                              const std::map<std::string, std::string>& settings) {
    const StableFluids solver;
    scene::Execution execution;
    execution.threads = 1;
    return solver.start(std::move(problem), scene::Settings(solver.settings(), settings), execution);
  }
  int dimensions_, n_, steps_;
  std::map<std::string, std::string> of_solver_;
  std::string state_;
  double energy_ = 0, speed_ = 0;
};

std::vector<double> decades(int from, int to, int per_decade) {
  std::vector<double> x;
  for (int i = from * per_decade; i <= to * per_decade; ++i) x.push_back(std::pow(10, double(i) / per_decade));
  return x;
}

}  // namespace

std::string FlowStability::about() const {
  return "growth of the energy of a stirred flow that nothing drives, over step and viscosity";
}

std::vector<scene::SettingSpec> FlowStability::settings() const {
  return {scene::choice_setting("scheme", "maccormack", {"semi_lagrangian", "maccormack", "bfecc"}, "of advection"),
          scene::choice_setting("interpolation", "linear", {"linear", "cubic"}, "between samples"),
          scene::choice_setting("limiter", "clamp", {"none", "clamp", "revert"}, "of corrections"),
          scene::choice_setting("trace", "2", {"1", "2", "4"}, "order of the method that finds the foot"),
          scene::choice_setting("precision", "float", {"float", "double"}, "of all fields"),
          scene::integer_setting("dimensions", "2", 2, 3, "of the box, 1 m a side"),
          scene::integer_setting("n", "32", 2, 512, "cells a side"),
          scene::integer_setting("steps", "50", 1, 1'000'000, "without a force"),
          scene::integer_setting("cfl_per_decade", "4", 1, 32, "cells of the map, from CFL 0.1 to 100"),
          scene::integer_setting("viscosity_per_decade", "1", 1, 32, "cells of the map, from 1e-6 to 1e6 m^2/s"),
          scene::real_setting("growth", "1.01", 1, 1e6, "beyond which a cell counts as growing")};
}

std::vector<std::string> FlowStability::figures() const {
  return {"greatest_growth", "greatest_growth_of_speed", "cells", "growing", "not_finite"};
}

Findings FlowStability::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  const Stirred flow(s, s.given(StableFluids().settings()));
  FigureMap map{"growth of the energy",
                {"CFL [cells a step]", decades(-1, 2, int(s.integer("cfl_per_decade")))},
                {"viscosity [m^2/s]", decades(-6, 6, int(s.integer("viscosity_per_decade")))},
                {},
                {}};
  const std::size_t columns = map.y.values.size(), cells = map.x.values.size() * columns;
  std::vector<Growth> growths(cells);
  scene::parallel_for(int(cells), execution,
                      [&](int i) { growths[i] = flow.growth(map.x.values[i / columns], map.y.values[i % columns]); });
  Growth greatest;
  int growing = 0, not_finite = 0;
  std::size_t worst = 0;
  std::string which;
  for (std::size_t i = 0; i < cells; ++i) {
    const Growth& g = growths[i];
    map.values.push_back(std::isinf(g.energy) ? std::nan("") : g.energy);
    greatest.energy = std::max(greatest.energy, g.energy);
    greatest.speed = std::max(greatest.speed, g.speed);
    not_finite += std::isinf(g.energy);
    if (!(g.energy > s.real("growth"))) continue;
    ++growing;
    if (g.energy >= growths[worst].energy) worst = i;
  }
  if (growing)
    which = fmt::format("grows most at CFL {:.3g}, viscosity {:.1g} m^2/s", map.x.values[worst / columns],
                        map.y.values[worst % columns]);
  // CFL 1; and the viscosity beyond which an explicit step would not be stable: nu dt / h^2 = 1 / (2 dimensions).
  const double n = double(s.integer("n")), dimensions = double(s.integer("dimensions"));
  map.lines.resize(2);
  for (const double viscosity : map.y.values) map.lines[0].push_back({1, viscosity});
  for (const double cfl : map.x.values) map.lines[1].push_back({cfl, flow.speed() / (2 * dimensions * cfl * n)});
  Findings found;
  found.figures = {exactly("greatest_growth", greatest.energy), exactly("greatest_growth_of_speed", greatest.speed),
                   exactly("cells", double(cells)), exactly("growing", growing), exactly("not_finite", not_finite)};
  found.note = which;
  found.map = std::move(map);
  return found;
}

}  // namespace airlight::experiments
