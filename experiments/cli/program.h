// The program `airlight`: parses the command line, runs the command, turns failures into one line and an exit code.
#pragma once

namespace airlight::experiments::cli {

// 0 success, 1 failed gate or comparison, 2 bad input or usage, 3 missing hardware or library, 130 interrupted.
int run(int argc, char** argv);

}  // namespace airlight::experiments::cli
