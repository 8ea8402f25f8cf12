#include "reference/stable_fluids/stable_fluids.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "reference/stable_fluids/grid_flow.h"

namespace airlight::stable_fluids {

using scene::FlowProblem;
using scene::Settings;

namespace {

constexpr double most_steps = 1e8;  // of a frame

struct Options {
  Plan plan;
  double dt = 0;       // [s], the longest step; 0: a frame
  double courant = 0;  // the longest step, in cells that 1 m/s crosses
  std::optional<PressureSolver> pressure;
  bool in_double = false;
};

void bind(scene::SettingBinder& b, Options& o) {
  using Solver = PressureSolver;
  Advection& advection = o.plan.advection;
  b.integer("n", o.plan.longest, 1, 2048, "cells along the longest axis of the box");
  b.real("dt", o.dt, 0, 1e9, "longest step [s]; 0: a frame. Steps divide a frame evenly");
  b.real("courant", o.courant, 0, 1e9,
         "longest step, in cells that 1 m/s crosses in it; 0: no bound. For steps in proportion to cells");
  b.choice("scheme", advection.scheme,
           {{"semi_lagrangian", Scheme::semi_lagrangian}, {"maccormack", Scheme::maccormack}, {"bfecc", Scheme::bfecc}},
           "of advection");
  b.choice("interpolation", advection.interpolation,
           {{"linear", Interpolation::linear}, {"cubic", Interpolation::cubic}}, "between samples; cubic is monotone");
  b.choice("limiter", advection.limiter,
           {{"none", Limiter::none}, {"clamp", Limiter::clamp}, {"revert", Limiter::revert}},
           "of what corrects beyond the samples around the foot")
      .where("scheme", {"maccormack", "bfecc"});
  b.choice("trace", advection.trace, {{"1", 1}, {"2", 2}, {"4", 4}},
           "order of the Runge-Kutta method that finds the foot");
  b.choice("pressure", o.pressure,
           {{"auto", std::nullopt},
            {"transforms", Solver::transforms},
            {"incomplete_cholesky", Solver::incomplete_cholesky},
            {"transforms_as_guess", Solver::transforms_as_guess}},
           "auto: transforms, or conjugate gradients by them where there are obstacles");
  const std::vector<std::string> by_gradients = {"auto", "incomplete_cholesky", "transforms_as_guess"};
  b.real("tolerance", o.plan.tolerance, 1e-15, 0.1, "of conjugate gradients: greatest residual, relative")
      .where("pressure", by_gradients);
  b.integer("iterations", o.plan.iterations, 1, 1'000'000, "at most, of conjugate gradients")
      .where("pressure", by_gradients);
  b.flag("project_twice", o.plan.project_twice, "before advection too");
  b.choice("precision", o.in_double, {{"float", false}, {"double", true}}, "of all fields");
}

Options read_options(const FlowProblem& problem, const Settings& settings) {
  Options o = scene::read_settings(bind, settings);
  o.plan.pressure =
      o.pressure.value_or(problem.obstacles.empty() ? PressureSolver::transforms : PressureSolver::transforms_as_guess);
  return o;
}

double steps_in_frame(const FlowProblem& problem, const Options& o) {
  const double frame = 1 / problem.frame_rate, h = problem.box.size().maxCoeff() / double(o.plan.longest);
  double steps = 1;
  for (const double longest : {o.dt, o.courant * h})
    if (longest > 0) steps = std::max(steps, std::ceil(frame / longest * (1 - 1e-9)));
  return steps;
}

}  // namespace

std::string StableFluids::about() const {
  return "Stam 1999 on a staggered grid: semi-Lagrangian, MacCormack or BFECC advection, implicit diffusion, projection";
}

std::vector<scene::SettingSpec> StableFluids::settings() const { return scene::list_settings(bind); }

std::vector<std::string> StableFluids::supports(const FlowProblem& problem, const Settings& settings) const {
  std::vector<std::string> reasons;
  if (!problem.densities.empty()) reasons.push_back("several densities");
  if (const auto* wind = std::get_if<scene::Wind>(&problem.velocity); wind && !wind->gust.isZero(0))
    reasons.push_back("a gust: it knows winds that begin a flow only");
  const Options o = read_options(problem, settings);
  const bool direct = o.plan.pressure == PressureSolver::transforms;
  if (direct && !problem.obstacles.empty())
    reasons.push_back("pressure = transforms solves in boxes without obstacles only");
  if (constexpr double rounding = std::numeric_limits<float>::epsilon();
      !direct && !o.in_double && o.plan.tolerance < rounding)
    reasons.push_back(
        fmt::format("tolerance = {:g} is below the rounding of precision = float, expected at least {:.2g}",
                    o.plan.tolerance, rounding));
  if (const double steps = steps_in_frame(problem, o); steps > most_steps)
    reasons.push_back(fmt::format("dt = {:g}, courant = {:g} make {:.3g} steps of a frame, expected at most {:g}", o.dt,
                                  o.courant, steps, most_steps));
  return reasons;
}

int StableFluids::steps_per_frame(const FlowProblem& problem, const Settings& settings) const {
  return int(std::min(most_steps, steps_in_frame(problem, read_options(problem, settings))));
}

std::unique_ptr<scene::Flow> StableFluids::start_supported(std::shared_ptr<const FlowProblem> problem,
                                                           const Settings& settings,
                                                           const scene::Execution& execution) const {
  Options o = read_options(*problem, settings);
  o.plan.threads = execution.threads;
  return o.in_double ? start_double(std::move(problem), o.plan) : start_float(std::move(problem), o.plan);
}

}  // namespace airlight::stable_fluids
