#include "reference/stable_fluids/stable_fluids.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "reference/stable_fluids/grid_flow.h"

namespace airlight::stable_fluids {

using scene::FlowProblem;
using scene::Settings;

namespace {

constexpr double most_steps = 1e8;  // of a frame

double steps_in_frame(const FlowProblem& problem, const Settings& settings) {
  const double frame = 1 / problem.frame_rate, h = problem.box.size().maxCoeff() / double(settings.integer("n"));
  double steps = 1;
  for (const double longest : {settings.real("dt"), settings.real("courant") * h})
    if (longest > 0) steps = std::max(steps, std::ceil(frame / longest * (1 - 1e-9)));
  return steps;
}

}  // namespace

std::string StableFluids::about() const {
  return "Stam 1999 on a staggered grid: semi-Lagrangian, MacCormack or BFECC advection, implicit diffusion, projection";
}

std::vector<scene::SettingSpec> StableFluids::settings() const {
  return {
      scene::integer_setting("n", "64", 1, 2048, "cells along the longest axis of the box"),
      scene::real_setting("dt", "0", 0, 1e9, "longest step [s]; 0: a frame. Steps divide a frame evenly"),
      scene::real_setting(
          "courant", "0", 0, 1e9,
          "longest step, in cells that 1 m/s crosses in it; 0: no bound. For steps in proportion to cells"),
      scene::choice_setting("scheme", "maccormack", {"semi_lagrangian", "maccormack", "bfecc"}, "of advection"),
      scene::choice_setting("interpolation", "linear", {"linear", "cubic"}, "between samples; cubic is monotone"),
      scene::choice_setting("limiter", "clamp", {"none", "clamp", "revert"},
                            "of what corrects beyond the samples around the foot"),
      scene::choice_setting("trace", "2", {"1", "2", "4"}, "order of the Runge-Kutta method that finds the foot"),
      scene::choice_setting("pressure", "auto", {"auto", "transforms", "incomplete_cholesky", "transforms_as_guess"},
                            "auto: transforms, or conjugate gradients by them where there are obstacles"),
      scene::real_setting("tolerance", "1e-6", 1e-15, 0.1, "of conjugate gradients: greatest residual, relative"),
      scene::integer_setting("iterations", "2000", 1, 1'000'000, "at most, of conjugate gradients"),
      scene::flag_setting("project_twice", false, "before advection too"),
      scene::choice_setting("precision", "float", {"float", "double"}, "of all fields"),
  };
}

std::vector<std::string> StableFluids::supports(const FlowProblem& problem, const Settings& settings) const {
  std::vector<std::string> reasons;
  if (!problem.densities.empty()) reasons.push_back("several densities");
  if (const auto* wind = std::get_if<scene::Wind>(&problem.velocity); wind && !wind->gust.isZero(0))
    reasons.push_back("a gust: it knows winds that begin a flow only");
  if (settings.text("pressure") == "transforms" && !problem.obstacles.empty())
    reasons.push_back("pressure = transforms solves in boxes without obstacles only");
  const std::string& pressure = settings.text("pressure");
  const bool by_gradients = pressure != "transforms" && (pressure != "auto" || !problem.obstacles.empty());
  if (constexpr double rounding = std::numeric_limits<float>::epsilon();
      by_gradients && settings.text("precision") == "float" && settings.real("tolerance") < rounding)
    reasons.push_back(
        fmt::format("tolerance = {:g} is below the rounding of precision = float, expected at least {:.2g}",
                    settings.real("tolerance"), rounding));
  if (const double steps = steps_in_frame(problem, settings); steps > most_steps)
    reasons.push_back(fmt::format("dt = {:g}, courant = {:g} make {:.3g} steps of a frame, expected at most {:g}",
                                  settings.real("dt"), settings.real("courant"), steps, most_steps));
  return reasons;
}

int StableFluids::steps_per_frame(const FlowProblem& problem, const Settings& settings) const {
  return int(std::min(most_steps, steps_in_frame(problem, settings)));
}

std::unique_ptr<scene::Flow> StableFluids::start_supported(std::shared_ptr<const FlowProblem> problem,
                                                           const Settings& settings,
                                                           const scene::Execution& execution) const {
  Plan plan;
  plan.longest = int(settings.integer("n"));
  plan.advection = {settings.choice<Scheme>("scheme"), settings.choice<Interpolation>("interpolation"),
                    settings.choice<Limiter>("limiter"), std::stoi(settings.text("trace"))};
  plan.tolerance = settings.real("tolerance");
  plan.iterations = int(settings.integer("iterations"));
  plan.project_twice = settings.flag("project_twice");
  plan.threads = execution.threads;
  const std::string& pressure = settings.text("pressure");
  plan.pressure = pressure == "incomplete_cholesky"                   ? PressureSolver::incomplete_cholesky
                  : pressure == "transforms_as_guess"                 ? PressureSolver::transforms_as_guess
                  : pressure == "auto" && !problem->obstacles.empty() ? PressureSolver::transforms_as_guess
                                                                      : PressureSolver::transforms;
  if (settings.text("precision") == "double") return start_double(std::move(problem), plan);
  return start_float(std::move(problem), plan);
}

}  // namespace airlight::stable_fluids
