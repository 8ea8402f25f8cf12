#include "experiments/driver/run.h"

#include "experiments/driver/check.h"
#include "experiments/driver/flows.h"
#include "experiments/driver/images.h"
#include "experiments/driver/numbers.h"

namespace airlight::experiments {

std::filesystem::path journal_file(const Folders& folders, const Experiment& e) {
  return folders.rows / (e.id + "." + e.profile + ".jsonl");
}

Outcome run_experiment(Experiment experiment, const RunOptions& options) {
  if (options.threads > 0) experiment.timing.threads = options.threads;
  if (!options.checked) check_experiment(experiment, options);
  if (experiment.kind == "numbers") return run_numbers(std::move(experiment), options);
  if (experiment.kind == "flow") return run_flows(std::move(experiment), options);
  return run_images(std::move(experiment), options);
}

}  // namespace airlight::experiments
