#include "experiments/cli/program.h"

int main(int argc, char** argv) { return airlight::experiments::cli::run(argc, argv); }
