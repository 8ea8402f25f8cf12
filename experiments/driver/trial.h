// Pictures of 8x8 pixels, rendered before anything is written: a fault that shows only in a picture ends no long run.
#pragma once
#include "experiments/driver/run.h"

namespace airlight::experiments {

// Loads every scene, and renders what is not finished: the reference on every scene, each method on the first scene it is on; then judges
// the metrics on the layers that they look at. Without options.trials it renders nothing. Throws Error.
void try_pictures(const Experiment&, const RunOptions&);

}  // namespace airlight::experiments
