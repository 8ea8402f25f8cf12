#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/application/fit_sequence.h"
#include "experiments/application/progress.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "scene/load/parse_toml.h"

namespace airlight::experiments::cli {
namespace {

struct FitOptions {
  std::vector<std::string> files;
  std::string out, grid = "density", medium = "0", method = "gauss_newton";
  int gaussians = 1000, deleted = 3, inserted = 8, threshold = 0, threads = 0;
  double unit = 0, allowed = 1.1;
  bool keep = false;
};

int fit(const FitOptions& options) {
  FitSequence sequence;
  sequence.files = options.files;
  sequence.grid = options.grid;
  sequence.medium = options.medium;
  sequence.folder = options.out;
  sequence.threshold = options.threshold;
  sequence.options.gaussians = options.gaussians;
  sequence.options.unit = options.unit;
  sequence.options.deleted = options.deleted;
  sequence.options.inserted = options.inserted;
  sequence.options.allowed = options.allowed;
  sequence.options.resent = !options.keep;
  sequence.options.method = scene::fit_method_from(options.method);
  std::vector<FittedFrame> made;
  const FitReport report = [&] {
    Progress progress(fmt::format("fit {}", options.out));
    return fit_sequence(sequence, progress.execution(options.threads),
                        [&](const FittedFrame& f) { made.push_back(f); });
  }();
  for (const FittedFrame& f : made)
    fmt::print(
        "{}: {} Gaussians, squared error {:.3g} %, rms {:.3g} % of the greatest density where filled, residual {} bytes, {:.3g} s\n",
        f.name, f.gaussians, 100 * f.errors.squared_ratio, 100 * f.errors.rms_filled, f.residual_bytes, f.seconds);
  if (!report.frames.empty()) {
    const std::filesystem::path file = std::filesystem::path(options.out) / report.frames.back().name;
    fmt::print("# the last frame as a medium; sigma_t is the extinction at density 1 [1/m]\n");
    fmt::print("[[medium]]\ntype = \"fitted\"\nsigma_t = 1\ngaussians = {}\nresidual = {}\n",
               scene::load::toml_string(file.string() + ".csv"), scene::load::toml_string(file.string() + ".residual"));
  }
  fmt::print("{}: {} frames, {} of them from an earlier run; unit {:.6g} m\n", options.out, report.frames.size(),
             report.resumed, report.unit);
  return 0;
}

}  // namespace

void add_fit(Commands& commands) {
  const auto options = std::make_shared<FitOptions>();
  CLI::App* c = add_command(commands.app, "fit",
                            "fit smoke by sums of Gaussians and a compressed residual: one frame or a sequence");
  c->add_option(
      "FILES", options->files,
      "OpenVDB files in the order of time, or scenes with a grid medium (required); results are named after each file");
  c->add_option("--out,-o", options->out,
                "output folder (required); an interrupted run continues from what it finds there");
  c->add_option("--gaussians,-n", options->gaussians, "number of Gaussians in the first frame (default 1000)");
  c->add_option("--grid", options->grid, "grid of an OpenVDB file (default density)");
  c->add_option("--medium", options->medium, "medium of a scene: its name or number (default 0)");
  c->add_option(
      "--unit", options->unit,
      "length in metres; widths of Gaussians are 0.015 to 0.09 of it (default: cube root of the volume of the smoke's bounding box)");
  c->add_option("--delete", options->deleted,
                "remove this many of the least significant Gaussians before each later frame (default 3)");
  c->add_option("--insert", options->inserted,
                "insert at most this many Gaussians into a later frame that needs them (default 8)");
  c->add_option(
      "--allowed", options->allowed,
      "a later frame needs more Gaussians if its squared error exceeds that of the first frame by this factor (default 1.1)");
  c->add_flag(
      "--keep", options->keep,
      "do not move Gaussians to places of large error in later frames (as in the paper): fewer new Gaussians, larger errors");
  c->add_option("--threshold", options->threshold, "drop levels of the residual of this size or less (default 0)")
      ->check(CLI::Range(0, 126));
  std::vector<std::string> methods;
  for (const auto& [name, method] : scene::fit_methods()) methods.push_back(name);
  c->add_option("--method,-m", options->method,
                fmt::format("optimiser (default gauss_newton): {}", fmt::join(methods, ", ")));
  c->add_option("--threads", options->threads, "number of threads (default 0: all)")->check(CLI::Range(0, 4096));
  commands.add_limit(c);
  commands.add_data(c);
  commands.on(c, [options] {
    require(options->files.empty() ? "" : options->files.front(), "FILES");
    require(options->out, "--out");
    return fit(*options);
  });
}

}  // namespace airlight::experiments::cli
