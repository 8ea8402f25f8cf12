// Whole flows whose solution is known: a decaying vortex, rest, boxes whose lid moves.
#include <cmath>
#include <memory>

#include "experiments/stable_fluids/cavity.h"
#include "experiments/verify/fluid_tables.h"
#include "reference/stable_fluids/stable_fluids.h"

namespace airlight::experiments::verification {
namespace {

using namespace stable_fluids;
using scene::FlowProblem;

std::unique_ptr<scene::Flow> start(const FlowProblem& problem, std::map<std::string, std::string> settings) {
  const StableFluids solver;
  settings.try_emplace("precision", "double");
  const std::vector<scene::SettingSpec> specs = solver.settings();
  return solver.start(std::make_shared<const FlowProblem>(problem),
                      scene::Settings(specs, scene::without_unread(specs, settings)), {});
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
  out.add(relative(name + ", lost energy", 1 - row.numbers[3], 1 - flow->totals().energy / before, 0.05));
  out.add(relative(name + ", error", row.numbers[4], std::sqrt(error / norm), 0.05));
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
  const int steps = v["input"]["steps"].integer_in(1, 10000);
  const double expected = v["expected"]["max_speed_over_g_dt"].number();
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
              out.add(absolute(fine ? "speed over g dt, double" : "speed over g dt, float", expected,
                               flow->totals().greatest_speed / (9.81 * dt), fine ? 1e-12 : 1e-5));
            }
            return out;
          }};
}

// Steady flow: 48^2 cells in profile quick, 128^2 in profile paper.
void compare_cavity(const CavityTable& table, const CavityProfiles& known, bool regularized, int n, double tolerance,
                    Outcome& out) {
  const auto flow = steady_flow(usual_cavity(known.reynolds, regularized, n), {}).flow;
  const auto compare = [&](const char* what, const std::vector<double>& places, const std::vector<double>& expected,
                           auto at, int axis) {
    for (std::size_t i = 0; i < expected.size(); ++i)
      out.add(absolute(fmt::format("Re {}, {}^2, {}{}", known.reynolds, n, what, places[i]), expected[i],
                       flow->velocity(at(places[i]))[axis], tolerance));
  };
  compare("u at y = ", table.y, known.u, on_vertical, 0);
  compare("v at x = ", table.x, known.v, on_horizontal, 1);
}

Check read_cavity(const Value& v, bool regularized, double tolerance) {
  const CavityTable table = read_cavity_table(v);
  return {"", [=](VerifyProfile profile) {
            Outcome out;
            for (const CavityProfiles& known : table.profiles) {
              if (profile == VerifyProfile::quick && known.reynolds > 100) {
                out.left_out += int(known.u.size() + known.v.size());
                out.left_out_because = "Reynolds numbers above 100 are for the paper profile";
                continue;
              }
              compare_cavity(table, known, regularized, profile == VerifyProfile::quick ? 48 : 128, tolerance, out);
            }
            return out;
          }};
}

}  // namespace

Check read_fluid_flow(const Value& v) {
  const Value in = v["input"];
  if (in.has("rows") && in["rows"].text() == "scheme,trace_order,n,steps,energy_ratio,rel_error")
    return read_taylor_green(v);
  if (in.has("steps")) return read_rest(v);
  // The bars of the specification for 128^2 cells, with which the quick profile's 48^2 are judged too. The lid's profile stands in words.
  if (in.has("y")) return read_cavity(v, v["about"].text().find("16x^2(1-x)^2") != std::string::npos, 0.02);
  in.complain("rows, n and h, eps, steps, or y: a flow that is known");
}

}  // namespace airlight::experiments::verification
