#include <fmt/format.h>

#include <optional>

#include "experiments/application/flow_pictures.h"
#include "experiments/application/folders.h"
#include "experiments/application/progress.h"
#include "experiments/application/renderers.h"
#include "experiments/application/simulation.h"
#include "experiments/application/solvers.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/driver/sequences.h"
#include "scene/base/error.h"
#include "scene/scene.h"

namespace airlight::experiments::cli {

namespace {

struct SimulateOptions {
  std::string problem, method = "stable_fluids", out;
  Pairs settings, overrides;
  std::string sequence, profile = "quick";  // in place of a problem and a folder
  std::string root, cache;                  // folders, for a sequence
  std::string scene, renderer;              // of pictures of each frame; scene empty: none; renderer empty: by method
  Pairs renderer_settings;
  double exposure = 0;
  int threads = 0;
};

int simulate_sequence(const SimulateOptions& options) {
  if (options.profile != "quick" && options.profile != "paper")
    throw Error(fmt::format("--profile '{}': expected quick or paper", options.profile));
  const Folders folders{project_root(options.root), {}, options.cache};
  const std::string files = sequence_files(folders, options.sequence, options.profile, "--sequence");
  make_sequence(folders, options.sequence, options.profile, options.threads);
  fmt::print("{}\n", files);
  return 0;
}

// A grid is drawn by the ray marcher, a series of Legendre polynomials by its own method.
std::string default_renderer(const scene::Solver& solver) {
  return solver.name().starts_with("legendre_fluids") ? "legendre_fluids" : "ray_marcher";
}

// With what the pictures are made of, if there are any.
struct Pictured {
  Pictured(const SimulateOptions& options, const scene::Solver& solver) {
    if (options.scene.empty()) return;
    const std::string name = options.renderer.empty() ? default_renderer(solver) : options.renderer;
    const scene::Renderer& renderer = find_renderer(name, "--renderer");
    settings.emplace(renderer.settings(), options.renderer_settings, name);
    scene.emplace(scene::load_scene(options.scene));
    pictures.emplace(*scene, renderer, *settings, options.exposure, options.threads);
  }
  std::optional<scene::Settings> settings;
  std::optional<scene::Scene> scene;
  std::optional<FlowPictures> pictures;
};

int simulate(const SimulateOptions& options) {
  if (!options.sequence.empty()) return simulate_sequence(options);
  if (!options.root.empty() || !options.cache.empty()) throw Error("--root and --cache need --sequence");
  const scene::Solver& solver = find_solver(options.method, "--method");
  const scene::Settings settings(solver.settings(), options.settings, options.method);
  const auto problem = std::make_shared<const scene::FlowProblem>(scene::load_flow(options.problem, options.overrides));
  Pictured pictured(options, solver);
  Simulation simulation{problem, solver, settings, options.out};
  if (pictured.pictures) {
    const auto draw = [&](int frame, const auto& smoke) {
      pictured.pictures->draw(smoke, fmt::format("{}/{}.{:04d}.png", options.out, problem->name, frame));
    };
    simulation.look = draw;
    simulation.look_back = draw;
  }
  const SimulationReport report = [&] {
    Progress progress(fmt::format("{} {}", options.method, problem->name));
    return experiments::simulate(simulation, progress.execution(options.threads));
  }();
  fmt::print("{}: {} frames, {} of them from an earlier run\n", options.out, report.frames, report.resumed);
  fmt::print("energy {:.4g}, mass {:.4g}, greatest speed {:.4g} m/s, CFL {:.3g}, divergence {:.2g}\n",
             report.totals.energy, report.totals.mass, report.totals.greatest_speed, report.totals.cfl,
             report.totals.divergence);
  for (const auto& [stage, seconds] : report.times) fmt::print("{:32} {:10.3f} s\n", stage, seconds);
  if (pictured.pictures) {
    fmt::print("{:32} {:10.3f} s\n", "pictures", pictured.pictures->seconds());
    fmt::print("{:32} {:10}\n", "pictures drawn where it flows", pictured.pictures->on_device());
  }
  for (const auto& [name, value] : report.counters) fmt::print("{:32} {:10.6g}\n", name, value);
  return 0;
}

}  // namespace

void add_simulate(Commands& commands) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* c = add_command(commands.app, "simulate", "simulate a flow: frames as OpenVDB files, their history as CSV");
  c->add_option("PROBLEM", options->problem, "flow file with a table [flow] (required unless --sequence is given)");
  c->add_option("--method,-m", options->method,
                "solver: stable_fluids (default) or legendre_fluids, on the device legendre_fluids_gpu");
  c->add_option("--out,-o", options->out,
                "output folder (required); an interrupted run continues from what it finds there");
  add_pairs(c, "--set", options->settings, "change a setting of the method");
  add_pairs(c, "--override", options->overrides, "change a value of the flow file");
  c->add_option(
      "--sequence", options->sequence,
      "simulate a sequence of experiments/sequences.toml, if it is not cached, and print its files; excludes PROBLEM and --out");
  c->add_option(
      "--root", options->root,
      "folder of the project with --sequence (default: found above the current folder, else above the program)");
  c->add_option("--cache", options->cache, "folder of simulated smoke with --sequence (default: results/cache/)")
      ->type_name("FOLDER");
  c->add_option(
      "--scene", options->scene,
      "also draw each frame as NAME.0000.png, ...: a scene file whose first medium is replaced by the flow's smoke");
  c->add_option(
      "--renderer", options->renderer,
      "renderer of --scene (default ray_marcher; legendre_fluids for Legendre flows); legendre_fluids_gpu draws Legendre flows "
      "without a copy from the device");
  add_pairs(c, "--renderer-set", options->renderer_settings, "change a setting of the renderer");
  c->add_option("--exposure", options->exposure, "exposure of the pictures in powers of two (default 0)");
  c->add_option("--profile", options->profile, "profile of --sequence: quick (default) or paper");
  c->add_option("--threads", options->threads, "number of threads (default 0: all)")->check(CLI::Range(0, 4096));
  commands.add_limit(c);
  commands.add_unchecked(c);
  commands.add_data(c);
  commands.on(c, [options] {
    if (options->sequence.empty()) {
      require(options->problem, "PROBLEM");
      require(options->out, "--out");
    } else if (!options->problem.empty() || !options->out.empty()) {
      throw Error("--sequence has its own problem and folder: expected neither PROBLEM nor --out");
    }
    check_exposure(options->exposure);
    if (!options->sequence.empty() && !options->scene.empty())
      throw Error("--sequence has no pictures: expected no --scene");
    return simulate(*options);
  });
}

}  // namespace airlight::experiments::cli
