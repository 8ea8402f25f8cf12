// Rows of kind "flow": what a solver makes of a problem, at named times.
#pragma once
#include "experiments/driver/outcome.h"
#include "experiments/driver/run.h"

namespace airlight::experiments {

Outcome run_flows(Experiment, const RunOptions&);

// Loads every problem; the reference must solve each, and the times of the metrics must be those of frames. Throws Error.
void check_flows(const Experiment&);

}  // namespace airlight::experiments
