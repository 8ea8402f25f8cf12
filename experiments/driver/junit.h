// Gates as a JUnit report, for continuous integration.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

// Atomic. `error`, unless empty: what ended the command before all gates were judged. Throws Error.
void write_junit(const std::string& file, const std::vector<GateResult>&, const std::string& error = "");

}  // namespace airlight::experiments
