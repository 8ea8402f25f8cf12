// Gates as a JUnit report, for continuous integration.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

// Atomic. The time of a gate is that of the row which it judges: one render and its preparation. `error`, unless empty: what ended the command before all gates were judged. Throws Error.
void write_junit(const std::string& file, const std::vector<GateResult>&, const std::string& error = "");

}  // namespace airlight::experiments
