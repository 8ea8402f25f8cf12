#include <fmt/format.h>

#include "experiments/application/fit_sequence.h"
#include "experiments/application/progress.h"
#include "experiments/cli/commands.h"

namespace airlight::experiments::cli {

int fit(const FitCommand& command) {
  FitSequence sequence;
  sequence.files = command.files;
  sequence.grid = command.grid;
  sequence.medium = command.medium;
  sequence.folder = command.out;
  sequence.threshold = command.threshold;
  sequence.options.gaussians = command.gaussians;
  sequence.options.unit = command.unit;
  sequence.options.deleted = command.deleted;
  sequence.options.inserted = command.inserted;
  sequence.options.allowed = command.allowed;
  sequence.options.resent = !command.keep;
  sequence.options.method = scene::fit_method_from(command.method);
  std::vector<FittedFrame> made;
  const FitReport report = [&] {
    Progress progress(fmt::format("fit {}", command.out));
    return fit_sequence(sequence, progress.execution(command.threads),
                        [&](const FittedFrame& f) { made.push_back(f); });
  }();
  for (const FittedFrame& f : made)
    fmt::print(
        "{}: {} Gaussians, squared error {:.3g} %, rms {:.3g} % of the greatest density where filled, residual {} bytes, {:.3g} s\n",
        f.name, f.gaussians, 100 * f.errors.squared_ratio, 100 * f.errors.rms_filled, f.residual_bytes, f.seconds);
  fmt::print("{}: {} frames, {} of them from an earlier run; unit {:.6g} m\n", command.out, report.frames.size(),
             report.resumed, report.unit);
  return 0;
}

}  // namespace airlight::experiments::cli
