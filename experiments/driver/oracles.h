// Experiments of kind "oracles": vectors recomputed and counted by kind, with the worst error of each.
#pragma once
#include "experiments/driver/run.h"

namespace airlight::experiments {

// One gate for each kind: every number within its tolerance. Writes table.csv, summary.csv, table.md and run.json.
Outcome run_oracles(Experiment, const RunOptions&);

}  // namespace airlight::experiments
