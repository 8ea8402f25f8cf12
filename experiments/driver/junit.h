// Gates as a JUnit report, for continuous integration.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

// Atomic. Throws Error.
void write_junit(const std::string& file, const std::vector<GateResult>&);

}  // namespace airlight::experiments
