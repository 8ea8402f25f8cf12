#include <cmath>

#include "experiments/application/interrupt.h"
#include "experiments/stable_fluids/probes.h"
#include "experiments/stable_fluids/stages.h"
#include "reference/stable_fluids/pressure.h"
#include "scene/base/error.h"
#include "scene/geometry/shapes.h"

namespace airlight::experiments {
namespace {

using namespace stable_fluids;

const scene::Choices<PressureSolver> solvers{{"transforms", PressureSolver::transforms},
                                             {"incomplete_cholesky", PressureSolver::incomplete_cholesky},
                                             {"transforms_as_guess", PressureSolver::transforms_as_guess}};

template <class Real>
void settle(Velocity<Real>& u, const Lattice& l, const Obstacles& obstacles) {
  for (Field<Real>& component : u) {
    stop_at_obstacles(obstacles, component);
    fill_ghosts(component, Quantity::velocity, l);
  }
}

// Noise on every face, or what a warm ball near the floor does to a fluid at rest.
template <class Real>
Velocity<Real> velocity_before(const Lattice& l, bool noise) {
  Velocity<Real> u;
  for (int a = 0; a < 3; ++a) u[a] = noise ? noise_field<Real>(l, a) : Field<Real>(l, a);
  if (!noise)
    for_rows(u[1].n, [&](int j, int k) {
      for (int i = 0; i < u[1].n[0]; ++i) {
        const Vec3 way = u[1].position(l, i, j, k) - Point3(0.5, 0.25, 0.5);
        u[1].at(i, j, k) = Real(std::exp(-way.squaredNorm() / 0.0225));
      }
    });
  return u;
}

std::vector<scene::Surface> obstacles_of(const std::string& name) {
  if (name == "ball") return {{name, scene::Sphere{Point3(0.5, 0.6, 0.45), 0.2}, {}}};
  if (name == "plate") return {{name, scene::make_box({Point3(-1, 0.45, -1), Point3(0.8, 0.55, 2)}), {}}};
  return {};
}

template <class Real>
Findings measure_pressure(const scene::Settings& s) {
  scene::FlowProblem problem = unit_cube(scene::Side::Kind::free_slip);
  const Lattice l = make_lattice(problem, int(s.integer("n")));
  problem.obstacles = obstacles_of(s.text("obstacle"));
  const Obstacles obstacles = make_obstacles(problem, l), none;
  const auto which = s.choice("solver", solvers);
  Projection<Real> project(l, obstacles, which, s.real("tolerance"), 100'000);
  Projection<Real> by_transforms(l, none, PressureSolver::transforms, 0, 0);
  Velocity<Real> start = velocity_before<Real>(l, s.text("start") == "noise"), u;
  settle(start, l, obstacles);
  std::vector<double> seconds, ratios;
  ProjectionReport report;
  repeat(int(s.integer("runs")), s.real("budget"), [&] {
    check_interrupted();
    u = start;
    scene::Stopwatch watch;
    by_transforms(u);
    const double direct = watch.lap();
    u = start;
    watch.lap();
    report = project(u);
    seconds.push_back(watch.lap());
    ratios.push_back(seconds.back() / direct);
  });
  settle(u, l, obstacles);
  Findings found;
  std::vector<double> each = seconds;
  for (double& t : each) t *= 1e9 / double(count_of(l.n));
  found.figures = {exactly("iterations", report.iterations), exactly("residual", report.residual),
                   exactly("divergence", greatest_divergence(u, l, obstacles) / greatest_speed(u)),
                   measured("ns_per_cell", each), measured("of_transforms", ratios)};
  found.counters = {{"cells", double(count_of(l.n))}, {"solid cells", double(obstacles.count)}};
  set_time(found, seconds);
  return found;
}

}  // namespace

std::string PressureSolvers::about() const {
  return "one projection by transforms or conjugate gradients: iterations, what is left of the divergence, time";
}

std::vector<scene::SettingSpec> PressureSolvers::settings() const {
  return {
      scene::choice_setting("solver", PressureSolver::transforms, solvers, "as pressure of stable_fluids"),
      scene::integer_setting("n", "32", 1, 1024, "cells a side of a cube"),
      scene::choice_setting("obstacle", "none", {"none", "ball", "plate"},
                            "a ball of radius 0.2 of a side, or a plate across but for a fifth; not with transforms"),
      scene::choice_setting("start", "noise", {"noise", "buoyancy"}, "of every face, or above a warm ball"),
      scene::choice_setting("precision", "float", {"float", "double"}, "of all fields"),
      scene::real_setting("tolerance", "1e-6", 1e-15, 0.1, "of conjugate gradients: greatest residual, relative"),
      scene::integer_setting("runs", "15", 1, 10000, "timed, each beside one by transforms in the empty box"),
      scene::real_setting("budget", "1", 0, 1e6, "seconds after which no further run begins")};
}

std::vector<std::string> PressureSolvers::figures() const {
  return {"iterations", "residual", "divergence", "ns_per_cell", "of_transforms"};
}

Findings PressureSolvers::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  if (s.text("obstacle") != "none" && s.text("solver") == "transforms")
    throw Error("solver = transforms solves in boxes without obstacles only");
  Findings found;
  with_threads(execution, [&] {
    found = s.text("precision") == "double" ? measure_pressure<double>(s) : measure_pressure<float>(s);
  });
  return found;
}

}  // namespace airlight::experiments
