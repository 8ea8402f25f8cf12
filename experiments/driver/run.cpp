#include "experiments/driver/run.h"

#include <fmt/format.h>

#include "experiments/driver/kind.h"
#include "experiments/driver/sequences.h"
#include "scene/base/error.h"

namespace airlight::experiments {

std::filesystem::path journal_file(const Folders& folders, const Experiment& e) {
  return folders.rows / (e.id + "." + e.profile + ".jsonl");
}

void check_experiment(const Experiment& e, const RunOptions& options) {
  try {
    for (const std::string& name : e.sequences)  // scenes cannot be looked at without
      make_sequence(options.folders, name, e.profile, e.timing.threads);
    e.kind->check(e, options);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", e.id, error.what()), error.exit_code());
  }
}

Outcome run_experiment(Experiment experiment, const RunOptions& options) {
  if (options.threads > 0) experiment.timing.threads = options.threads;
  if (!options.checked) check_experiment(experiment, options);
  const ExperimentKind& kind = *experiment.kind;
  return kind.run(std::move(experiment), options);
}

}  // namespace airlight::experiments
