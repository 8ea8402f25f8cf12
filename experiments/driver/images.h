// Rows of kind "images": a renderer's film judged against a reference's.
#pragma once
#include "experiments/driver/outcome.h"
#include "experiments/driver/run.h"

namespace airlight::experiments {

Outcome run_images(Experiment, const RunOptions&);

}  // namespace airlight::experiments
