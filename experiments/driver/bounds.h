// Bounds by row, experiments/<group>/<name>.bounds.csv: what profile quick is held to, close to what was measured.
// scripts/tighten writes the file from the committed tables.
#pragma once
#include "experiments/driver/experiment.h"

namespace airlight::experiments {

// Puts the lines of the file before the experiment's gates: one gate for every row, metric and bound, exact names, why
// from the first [[gate]] that covers it. No file: no change. Throws Error: file:line, what was found, what was
// expected.
void add_bounds(Experiment&, const std::filesystem::path& file);

}  // namespace airlight::experiments
