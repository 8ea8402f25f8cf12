#include <fmt/format.h>

#include "experiments/cli/commands.h"
#include "experiments/driver/sequences.h"
#include "experiments/folders.h"
#include "experiments/progress.h"
#include "experiments/simulation.h"
#include "experiments/solvers.h"
#include "scene/error.h"

namespace airlight::experiments::cli {

namespace {

int simulate_sequence(const SimulateOptions& options) {
  if (options.profile != "quick" && options.profile != "paper")
    throw Error(fmt::format("--profile '{}': expected quick or paper", options.profile));
  const auto root = project_root("");
  const std::string files = sequence_files(root, options.sequence, options.profile, "--sequence");
  make_sequence(root, options.sequence, options.profile, options.threads);
  fmt::print("{}\n", files);
  return 0;
}

}  // namespace

int simulate(const SimulateOptions& options) {
  if (!options.sequence.empty()) return simulate_sequence(options);
  const scene::Solver& solver = find_solver(options.method, "--method");
  const scene::Settings settings(solver.settings(), options.settings, options.method);
  const auto problem = std::make_shared<const scene::FlowProblem>(scene::load_flow(options.problem, options.overrides));
  const SimulationReport report = [&] {
    Progress progress(fmt::format("{} {}", options.method, problem->name));
    return experiments::simulate({problem, solver, settings, options.out}, progress.execution(options.threads));
  }();
  fmt::print("{}: {} frames, {} of them from an earlier run\n", options.out, report.frames, report.resumed);
  fmt::print("energy {:.4g}, mass {:.4g}, greatest speed {:.4g} m/s, CFL {:.3g}, divergence {:.2g}\n",
             report.totals.energy, report.totals.mass, report.totals.greatest_speed, report.totals.cfl,
             report.totals.divergence);
  for (const auto& [stage, seconds] : report.times) fmt::print("{:32} {:10.3f} s\n", stage, seconds);
  for (const auto& [name, value] : report.counters) fmt::print("{:32} {:10.6g}\n", name, value);
  return 0;
}

}  // namespace airlight::experiments::cli
