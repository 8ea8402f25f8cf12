#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/legendre_fluids/fluid_probes.h"
#include "experiments/stable_fluids/stages.h"
#include "methods/legendre_fluids/legendre_fluids.h"
#include "reference/stable_fluids/stable_fluids.h"

namespace airlight::experiments {
namespace {

using Given = std::map<std::string, std::string>;

// Sizes in the paper's figures 10 and 11: coefficients along an axis, cells along an axis.
const std::vector<int> coefficients[2] = {{4, 6, 8, 10, 12, 16}, {3, 4, 5, 6, 8}};
const std::vector<int> cells[2] = {{64, 128, 256, 512}, {16, 32, 64, 96}};

// Smoke in a swirl with viscosity, in a box that both solvers know.
std::shared_ptr<const scene::FlowProblem> swirl(int dimensions) {
  auto problem = std::make_shared<scene::FlowProblem>();
  problem->dimensions = dimensions;
  problem->box = {Point3(-1, -1, dimensions == 2 ? 0 : -1), Point3(1, 1, dimensions == 2 ? 0 : 1)};
  problem->viscosity = 1e-3;
  problem->velocity = scene::Swirl{1};
  problem->blobs.push_back({Point3(0.35, 0, 0), 0.4, 1, 0});
  return problem;
}

// [ms] of steps of 0.01 s, one each; the first one is not counted.
template <class Solver>
std::vector<double> step_times(int dimensions, const Given& settings, int runs, double budget) {
  const Solver solver;
  scene::Execution execution;
  execution.threads = 1;
  const auto flow = solver.start(swirl(dimensions), scene::Settings(solver.settings(), settings), execution);
  std::vector<double> ms;
  flow->step(0.01);
  repeat(runs, budget, [&] {
    scene::Stopwatch watch;
    flow->step(0.01);
    ms.push_back(1e3 * watch.lap());
  });
  return ms;
}

}  // namespace

std::string LegendreSpeed::about() const {
  return "time of a step of Legendre fluids and of Stable Fluids, and their ratios, as figures 10 and 11; one thread";
}

std::vector<scene::SettingSpec> LegendreSpeed::settings() const {
  return {scene::integer_setting("dimensions", "2", 2, 3, "of the box"),
          scene::choice_setting("variant", "galerkin", {"galerkin", "paper", "paper_repaired"}, "of Legendre fluids"),
          scene::choice_setting("scheme", "semi_lagrangian", {"semi_lagrangian", "maccormack", "bfecc"},
                                "of Stable Fluids"),
          scene::integer_setting("runs", "31", 1, 10000, "steps of each"),
          scene::real_setting("budget", "1", 0, 1e6, "seconds after which no further step begins")};
}

std::vector<std::string> LegendreSpeed::figures() const {
  std::vector<std::string> names{"least_ratio", "greatest_ratio", "cells", "over_10", "over_1000"};
  for (const int d : {0, 1}) {
    for (const int n : coefficients[d]) names.push_back(fmt::format("ms_{}", int(std::pow(n, d + 2) + 0.5)));
    for (const int n : cells[d]) names.push_back(fmt::format("ms_grid_{}", n));
    for (const int n : coefficients[d])
      for (const int m : cells[d]) names.push_back(fmt::format("ratio_{}_{}", int(std::pow(n, d + 2) + 0.5), m));
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Findings LegendreSpeed::run(const ProbeInput&, const scene::Settings& s, const scene::Execution&) const {
  const int dimensions = int(s.integer("dimensions")), runs = int(s.integer("runs"));
  const double budget = s.real("budget");
  Findings found;
  FigureMap map{"times faster", {"coefficients", {}}, {"cells along an axis", {}}, {}, {}};
  std::vector<double> ours, grids;
  const auto keep = [&](const std::string& name, const std::vector<double>& ms, std::vector<double>& all) {
    found.figures.push_back(measured(name, ms));
    all.push_back(found.figures.back().value);
  };
  for (const int n : coefficients[dimensions - 2]) {
    map.x.values.push_back(std::pow(n, dimensions));
    keep(fmt::format("ms_{:.0f}", map.x.values.back()),
         step_times<legendre_fluids::LegendreFluids>(
             dimensions, {{"n", std::to_string(n)}, {"variant", s.text("variant")}}, 10 * runs, budget),
         ours);
  }
  for (const int m : cells[dimensions - 2]) {
    map.y.values.push_back(m);
    keep(fmt::format("ms_grid_{}", m),
         step_times<stable_fluids::StableFluids>(dimensions, {{"n", std::to_string(m)}, {"scheme", s.text("scheme")}},
                                                 runs, budget),
         grids);
  }
  double least = infinity, greatest = 0;
  int over_10 = 0, over_1000 = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    for (std::size_t j = 0; j < grids.size(); ++j) {
      const double ratio = grids[j] / ours[i];
      map.values.push_back(ratio);
      found.figures.push_back(
          exactly(fmt::format("ratio_{:.0f}_{}", map.x.values[i], cells[dimensions - 2][j]), ratio));
      least = std::min(least, ratio), greatest = std::max(greatest, ratio);
      over_10 += ratio >= 10, over_1000 += ratio >= 1000;
    }
  found.figures.push_back(exactly("least_ratio", least));
  found.figures.push_back(exactly("greatest_ratio", greatest));
  found.figures.push_back(exactly("cells", double(map.values.size())));
  found.figures.push_back(exactly("over_10", over_10));
  found.figures.push_back(exactly("over_1000", over_1000));
  found.map = std::move(map);
  return found;
}

}  // namespace airlight::experiments
