// `experiment plan` and `experiment reference`: experiments on many computers.
#pragma once
#include "experiments/cli/command_line.h"

namespace airlight::experiments::cli {

void add_plan(Commands&, CLI::App& experiment);
void add_reference(Commands&, CLI::App& experiment);

}  // namespace airlight::experiments::cli
