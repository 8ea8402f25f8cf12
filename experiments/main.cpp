// The command line `airlight`: see experiments/cli.h.
#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
  CLI::App app{"airlight: fog and smoke in real time, judged against references"};
  CLI11_PARSE(app, argc, argv);
  return 0;
}
