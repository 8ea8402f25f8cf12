// How far gates are from failing: `airlight gates --margins`.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

// How many times worse the figure could be before the gate objects: bound over measured for at_most, measured over
// bound for at_least; below 1 a gate fails, unless noise explains it. 1 where both are 0, infinite where only what is
// divided by is. Where both are negative, by their sizes. NaN where there is no figure, or one on the far side of 0 (a
// negative bias under an upper bound).
double margin(const GateResult&);

// A line for each gate, the loosest first: ratio, bound, measured with its interval, kind, name; then how many there
// are of which ratio.
std::string margins_text(const std::vector<GateResult>&);

// The margins as CSV: ratio, at_most or at_least, bound, measured, low, high, kind, result (ok, skipped, FAILED),
// experiment, scene, method, setting, metric, position of the [[gate]] in its file. Undefined values are empty.
std::string margins_csv(const std::vector<GateResult>&);

}  // namespace airlight::experiments
