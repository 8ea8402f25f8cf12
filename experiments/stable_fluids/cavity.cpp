#include "experiments/stable_fluids/cavity.h"

#include <cmath>

#include "experiments/application/interrupt.h"
#include "experiments/application/json_value.h"
#include "experiments/verify/fluid_tables.h"
#include "reference/stable_fluids/stable_fluids.h"

namespace airlight::experiments {
namespace {

std::unique_ptr<scene::Flow> start(const Cavity& cavity, const scene::Execution& execution) {
  auto problem = std::make_shared<scene::FlowProblem>(verification::flat_problem(1, scene::Side::Kind::no_slip));
  problem->viscosity = 1 / cavity.reynolds;
  problem->sides[1][1].velocity = Vec3(1, 0, 0);
  problem->sides[1][1].regularized = cavity.regularized;
  const stable_fluids::StableFluids solver;
  const scene::Settings settings(solver.settings(), {{"n", std::to_string(cavity.n)}, {"precision", "double"}});
  return solver.start(problem, settings, execution);
}

std::vector<Vec3> along_both_middles(const scene::Flow& flow, int n) {
  std::vector<Vec3> velocities;
  for (int i = 0; i < n; ++i) {
    velocities.push_back(flow.velocity(on_vertical((i + 0.5) / n)));
    velocities.push_back(flow.velocity(on_horizontal((i + 0.5) / n)));
  }
  return velocities;
}

}  // namespace

const CavityProfiles* CavityTable::find(double reynolds) const {
  for (const CavityProfiles& p : profiles)
    if (p.reynolds == reynolds) return &p;
  return nullptr;
}

CavityTable read_cavity_table(const verification::Value& v) {
  CavityTable table{v["input"]["y"].numbers(), {}, {}};
  if (v["input"].has("x")) table.x = v["input"]["x"].numbers();
  for (const std::string& reynolds : v["expected"].fields()) {
    const verification::Value expected = v["expected"][reynolds];
    const bool both = !expected.is_array();
    const nlohmann::json name = reynolds;
    table.profiles.push_back({verification::Value(name, expected.where() + ", its name").number_in(1e-3, 1e6),
                              (both ? expected["u"] : expected).numbers(),
                              both ? expected["v"].numbers() : std::vector<double>{}});
    const CavityProfiles& p = table.profiles.back();
    if (p.u.size() != table.y.size() || p.v.size() != table.x.size()) expected.complain("as many numbers as places");
  }
  return table;
}

Cavity usual_cavity(double reynolds, bool regularized, int n) {
  return {reynolds, regularized, n, reynolds <= 400 ? 1 : 0.25, reynolds <= 100 ? 25.0 : 50.0};
}

SteadyFlow steady_flow(const Cavity& cavity, const scene::Execution& execution) {
  SteadyFlow found{start(cavity, execution), 0};
  const double dt = cavity.cfl / cavity.n;
  const int steps = int(std::lround(cavity.seconds / dt)), last = std::max(1, int(std::lround(1 / dt)));
  std::vector<Vec3> before;
  for (int i = 0; i < steps; ++i) {
    if (i == std::max(0, steps - last)) before = along_both_middles(*found.flow, cavity.n);
    check_interrupted();
    found.flow->step(dt);
  }
  const std::vector<Vec3> after = along_both_middles(*found.flow, cavity.n);
  for (std::size_t i = 0; i < before.size(); ++i)
    found.change = std::max(found.change, (after[i] - before[i]).cwiseAbs().maxCoeff() / (last * dt));
  return found;
}

}  // namespace airlight::experiments
