// Whether an experiment can be computed as its file says, found out before anything is written.
#pragma once
#include "experiments/driver/run.h"

namespace airlight::experiments {

// Loads every scene with its overrides and tries everything that is not finished on a film of at most 8x8 pixels: the
// reference on every scene, each method on the first scene it is on; then the metrics, on the layers that they look at.
// With options.resume, rows of an earlier run count as finished. Writes nothing. Throws Error in one line that begins
// with the experiment. What this machine lacks is not tried. Without options.trials everything is loaded and planned, nothing rendered.
void check_experiment(const Experiment&, const RunOptions&);

}  // namespace airlight::experiments
