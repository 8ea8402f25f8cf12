#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/application/fit_sequence.h"
#include "experiments/application/progress.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"

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
  fmt::print("{}: {} frames, {} of them from an earlier run; unit {:.6g} m\n", options.out, report.frames.size(),
             report.resumed, report.unit);
  return 0;
}

}  // namespace

void add_fit(Commands& commands) {
  const auto options = std::make_shared<FitOptions>();
  CLI::App* c = add_command(commands.app, "fit",
                            "smoke as sums of Gaussians and small residuals: a frame, or a sequence of them");
  c->add_option(
      "FILES", options->files,
      "OpenVDB files in the order of time, or scenes with a medium that is a grid; the results of FILE are called after it");
  c->add_option("--out,-o", options->out, "folder; what an earlier run left there is gone on with");
  c->add_option("--gaussians,-n", options->gaussians, "of the first frame (1000)");
  c->add_option("--grid", options->grid, "of an OpenVDB file (density)");
  c->add_option("--medium", options->medium, "of a scene: name or number (0)");
  c->add_option(
      "--unit", options->unit,
      "METRES: of widths, which are 0.015 to 0.09 of it (default: the cube root of the volume of the box that all frames fill)");
  c->add_option("--delete", options->deleted, "so many of the least significant before each later frame (3)");
  c->add_option("--insert", options->inserted, "at most so many into each later frame that needs them (8)");
  c->add_option("--allowed", options->allowed,
                "a later frame needs more where its squared error is this many times that of the first (1.1)");
  c->add_flag("--keep", options->keep,
              "send none to another place in later frames, as the publication: fewer new ones, greater errors");
  c->add_option("--threshold", options->threshold, "residual: levels of this size or less are dropped (0)")
      ->check(CLI::Range(0, 126));
  std::vector<std::string> methods;
  for (const auto& [name, method] : scene::fit_methods()) methods.push_back(name);
  c->add_option("--method,-m", options->method, fmt::format("one of {}", fmt::join(methods, ", ")));
  c->add_option("--threads", options->threads, "0: all")->check(CLI::Range(0, 4096));
  commands.add_limit(c);
  commands.add_data(c);
  commands.on(c, [options] {
    require(options->files.empty() ? "" : options->files.front(), "FILES");
    require(options->out, "--out");
    return fit(*options);
  });
}

}  // namespace airlight::experiments::cli
