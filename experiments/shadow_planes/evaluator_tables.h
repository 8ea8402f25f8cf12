// What `airlight evaluators` writes.
#pragma once
#include <filesystem>

namespace airlight::experiments::shadow_planes {

struct EvaluatorEffort {
  int per_decade = 4;  // cells of the map along each axis
  int cases = 20000;   // random ones of the tables
  int runs = 15;       // of every evaluator's time, of which the fastest counts
};

// Measures (evaluator_errors.h) and writes map.csv, shares.csv, angles.csv, image.csv, times.csv, table.md, run.json
// and plots/ into the folder. Without gnuplot one line on standard error says that there are no plots. Throws Error.
void write_evaluator_tables(const std::filesystem::path& folder, const EvaluatorEffort&);

}  // namespace airlight::experiments::shadow_planes
