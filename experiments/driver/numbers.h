// Rows of kind "numbers": what a probe finds.
#pragma once
#include "experiments/driver/outcome.h"
#include "experiments/driver/run.h"

namespace airlight::experiments {

Outcome run_numbers(Experiment, const RunOptions&);

// Content of the file of a [[scene]]: of a scene file the scene's hash. Throws Error for one that is no good.
std::string input_key(const SceneCase&);

}  // namespace airlight::experiments
