// Whole flows whose solution is known: a decaying vortex, rest, boxes whose lid moves.
#include <cmath>
#include <memory>

#include "experiments/verify/fluid_tables.h"
#include "reference/stable_fluids/stable_fluids.h"

namespace airlight::experiments::verification {
namespace {

using namespace stable_fluids;
using scene::FlowProblem;

std::unique_ptr<scene::Flow> start(const FlowProblem& problem, std::map<std::string, std::string> settings) {
  const StableFluids solver;
  settings.try_emplace("precision", "double");
  return solver.start(std::make_shared<const FlowProblem>(problem), scene::Settings(solver.settings(), settings), {});
}

// Columns scheme, order of the trace, n, steps, energy ratio, error over the norm at first.
void compare_taylor_green(const Row& row, Outcome& out) {
  const int n = row.whole(1), steps = row.whole(2);
  FlowProblem problem = flat_problem(2 * pi, scene::Side::Kind::periodic);
  problem.viscosity = 0.01;
  problem.velocity = scene::TaylorGreen{};
  const auto flow =
      start(problem, {{"n", std::to_string(n)},
                      {"limiter", "none"},
                      {"trace", std::to_string(row.whole(0))},
                      {"scheme", row.advection() == Scheme::maccormack ? "maccormack" : "semi_lagrangian"}});
  const double before = flow->totals().energy, h = 2 * pi / n;
  for (int i = 0; i < steps; ++i) flow->step(1.0 / steps);
  double error = 0, norm = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (int a = 0; a < 2; ++a) {
        const Point3 x((i + (a == 0 ? 0 : 0.5)) * h, (j + (a == 1 ? 0 : 0.5)) * h, 0);
        const double start = velocity_at(problem.velocity, problem.box, x)[a];
        error += std::pow(flow->velocity(x)[a] - std::exp(-0.02) * start, 2);
        norm += start * start;
      }
  const std::string name = fmt::format("{}, trace {}, {}", row.scheme, row.whole(0), n);
  out.comparisons.push_back(
      relative(name + ", lost energy", 1 - row.numbers[3], 1 - flow->totals().energy / before, 0.05));
  out.comparisons.push_back(relative(name + ", error", row.numbers[4], std::sqrt(error / norm), 0.05));
}

Check read_taylor_green(const Value& v) {
  const auto rows = read_rows(v["expected"]["rows"], true, 5);
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (const Row& row : rows) compare_taylor_green(row, out);
            return out;
          }};
}

Check read_rest(const Value& v) {
  const int steps = v["input"]["steps"].integer();
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (const bool fine : {true, false}) {
              FlowProblem problem;
              problem.gravity = Vec3(0, -9.81, 0);
              problem.weight = 0.5;
              problem.expansion = 0.01;
              problem.density = 1;
              problem.temperature = 20;
              const auto flow = start(problem, {{"n", "16"}, {"precision", fine ? "double" : "float"}});
              const double dt = 0.04;
              for (int i = 0; i < steps; ++i) flow->step(dt);
              out.comparisons.push_back(absolute(fine ? "speed over g dt, double" : "speed over g dt, float", 0,
                                                 flow->totals().greatest_speed / (9.81 * dt), fine ? 1e-12 : 1e-5));
            }
            return out;
          }};
}

// Velocities along the middles of a box whose lid moves, at one Reynolds number.
struct Cavity {
  double reynolds;
  std::vector<double> u, v;  // u along x = 0.5, v along y = 0.5; v may be empty
};

// Steady flow: 48^2 cells in profile quick, 128^2 in profile paper.
void compare_cavity(const Cavity& cavity, bool regularized, const std::vector<double>& y, const std::vector<double>& x,
                    int n, double tolerance, Outcome& out) {
  FlowProblem problem = flat_problem(1, scene::Side::Kind::no_slip);
  problem.viscosity = 1 / cavity.reynolds;
  problem.sides[1][1].velocity = Vec3(1, 0, 0);
  problem.sides[1][1].regularized = regularized;
  const auto flow = start(problem, {{"n", std::to_string(n)}});
  // Until it is steady. Advection followed by a projection is first order in time, which shows where little else damps.
  const double seconds = cavity.reynolds <= 100 ? 25 : 50, cfl = cavity.reynolds <= 400 ? 1 : 0.25;
  for (int i = 0; i < seconds * n / cfl; ++i) flow->step(cfl / n);
  const auto compare = [&](const char* what, const std::vector<double>& places, const std::vector<double>& expected,
                           auto at, int axis) {
    for (std::size_t i = 0; i < expected.size(); ++i)
      out.comparisons.push_back(absolute(fmt::format("Re {}, {}^2, {}{}", cavity.reynolds, n, what, places[i]),
                                         expected[i], flow->velocity(at(places[i]))[axis], tolerance));
  };
  compare(
      "u at y = ", y, cavity.u, [](double c) { return Point3(0.5, c, 0); }, 0);
  compare(
      "v at x = ", x, cavity.v, [](double c) { return Point3(c, 0.5, 0); }, 1);
}

Check read_cavity(const Value& v, bool regularized, double tolerance) {
  const auto y = v["input"]["y"].numbers();
  const auto x = v["input"].has("x") ? v["input"]["x"].numbers() : std::vector<double>{};
  std::vector<Cavity> cavities;
  for (const std::string& reynolds : v["expected"].fields()) {
    const Value expected = v["expected"][reynolds];
    const bool both = !expected.is_array();
    cavities.push_back({std::stod(reynolds), (both ? expected["u"] : expected).numbers(),
                        both ? expected["v"].numbers() : std::vector<double>{}});
    if (cavities.back().u.size() != y.size() || cavities.back().v.size() != x.size())
      expected.complain("as many numbers as places");
  }
  return {"", [=](VerifyProfile profile) {
            Outcome out;
            for (const Cavity& cavity : cavities) {
              if (profile == VerifyProfile::quick && cavity.reynolds > 100) {
                out.left_out += int(cavity.u.size() + cavity.v.size());
                out.left_out_because = "Reynolds numbers above 100 are for the paper profile";
                continue;
              }
              compare_cavity(cavity, regularized, y, x, profile == VerifyProfile::quick ? 48 : 128, tolerance, out);
            }
            return out;
          }};
}

}  // namespace

Check read_fluid_flow(const Value& v) {
  const std::string& id = v["id"].text();
  if (id == "fluid-taylor-green") return read_taylor_green(v);
  if (id == "fluid-rest") return read_rest(v);
  // The bars of the specification for 128^2 cells, with which the quick profile's 48^2 are judged too.
  if (id == "fluid-cavity-regular") return read_cavity(v, true, 0.02);
  if (id == "fluid-cavity-lid" || id == "fluid-ghia-u") return read_cavity(v, false, 0.02);
  v["id"].complain("a flow that is known");
}

}  // namespace airlight::experiments::verification
