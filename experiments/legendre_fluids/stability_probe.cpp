#include <fmt/format.h>

#include <cmath>

#include "experiments/legendre_fluids/fluid_probes.h"
#include "methods/legendre_fluids/legendre_fluids.h"
#include "scene/base/threads.h"

namespace airlight::experiments {
namespace {

constexpr double tenfold = 10;

std::vector<double> decades(int from, int to, int per_decade) {
  std::vector<double> x;
  for (int i = from * per_decade; i <= to * per_decade; ++i) x.push_back(std::pow(10, double(i) / per_decade));
  return x;
}

struct Cell {
  int steps = 0;      // after which the energy was tenfold that of the start, or the run ended; else all
  double growth = 0;  // greatest energy there was, over that of the start
};

// In a box of 2 m: its half sizes are those of the paper's basis.
Cell stirred(const scene::Settings& s, double dt, double viscosity) {
  auto problem = std::make_shared<scene::FlowProblem>();
  problem->dimensions = 2;
  problem->box = {Point3(-1, -1, 0), Point3(1, 1, 0)};
  problem->viscosity = viscosity;
  problem->velocity = scene::Swirl{1};
  const legendre_fluids::LegendreFluids solver;
  std::map<std::string, std::string> settings = s.given(solver.settings());
  settings["variant"] = s.text("variant");
  settings["n"] = std::to_string(s.integer("n"));
  Cell cell;
  const auto flow = solver.start(problem, scene::Settings(solver.settings(), settings), {});
  const double before = flow->totals().energy;
  try {
    for (; cell.steps < s.integer("steps"); ++cell.steps) {
      flow->step(dt);
      cell.growth = std::max(cell.growth, flow->totals().energy / before);
      if (!(cell.growth < tenfold)) return cell;
    }
  } catch (const Error&) {  // it says that the energy has no end
    cell.growth = infinity;
  }
  return cell;
}

}  // namespace

std::string LegendreStability::about() const {
  return "steps until the energy of a swirl in Legendre fluids has grown tenfold, over step and viscosity";
}

std::vector<scene::SettingSpec> LegendreStability::settings() const {
  return {scene::choice_setting("variant", "galerkin", {"galerkin", "paper", "paper_repaired"}, "of the solver"),
          scene::choice_setting("truncation", "chebyshev", {"chebyshev", "l2"}, "T of the paper's variants"),
          scene::integer_setting("n", "8", 2, 32, "coefficients along each axis"),
          scene::integer_setting("steps", "200", 1, 1'000'000, "at most"),
          scene::integer_setting("per_decade", "1", 1, 32,
                                 "cells: steps from 1e-4 to 10 s, viscosities from 1e-6 to 1e3 m^2/s")};
}

std::vector<std::string> LegendreStability::figures() const {
  return {"cells", "unstable", "least_steps", "greatest_growth"};
}

Findings LegendreStability::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  const int per_decade = int(s.integer("per_decade"));
  FigureMap map{"steps until the energy is tenfold",
                {"step [s]", decades(-4, 1, per_decade)},
                {"viscosity [m^2/s]", decades(-6, 3, per_decade)},
                {},
                {}};
  const std::size_t columns = map.y.values.size(), count = map.x.values.size() * columns;
  std::vector<Cell> cells(count);
  scene::parallel_for(int(count), execution,
                      [&](int i) { cells[i] = stirred(s, map.x.values[i / columns], map.y.values[i % columns]); });
  int unstable = 0, least = int(s.integer("steps"));
  double growth = 0;
  for (const Cell& c : cells) {
    map.values.push_back(c.steps);
    unstable += !(c.growth < tenfold);
    least = std::min(least, c.steps);
    if (std::isfinite(c.growth)) growth = std::max(growth, c.growth);
  }
  Findings found;
  found.figures = {exactly("cells", double(count)), exactly("unstable", unstable), exactly("least_steps", least),
                   exactly("greatest_growth", growth)};
  found.note = unstable ? fmt::format("{} of {} cells end", unstable, count) : "";
  found.map = std::move(map);
  return found;
}

}  // namespace airlight::experiments
