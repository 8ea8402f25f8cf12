// Runs an experiment: references, methods, errors, times; then tables, plots, pictures and the record.
#pragma once
#include <filesystem>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

struct RunOptions {
  std::filesystem::path root;
  bool resume = false;
  int threads = 0;   // 0: what the experiment says
  bool talk = true;  // one line per row on standard output
};

// Everything below root/results (results_name). Interrupted: writes what is finished, then throws scene::Interrupted. A
// scene that fails is left out, the others are computed and written, then its Error is thrown.
Outcome run_experiment(Experiment, const RunOptions&);

}  // namespace airlight::experiments
