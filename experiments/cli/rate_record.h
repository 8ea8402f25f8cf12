// What `airlight rate` measured, as lines for people and as a record among the results.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace airlight::experiments::cli {

// One variant of fogshop on one scene; rates in millions per second.
struct RateRow {
  std::string variant, erf;
  int slices = 0;  // 0: the variant has none
  int threads = 0;
  double pairs_per_ray = 0;
  double evaluations = 0, bare_evaluations = 0;  // of the kernel: in whole pictures, in the bare loop
  double erf_calls = 0, bare_erf_calls = 0;
};

struct RateRun {
  std::string scene;  // name, for people
  std::string how;    // pixels, runs, kind of time
  std::string command;
  std::vector<RateRow> rows;
};

std::string rate_text(const RateRun&);

// rate.csv, table.md and run.json in the folder, which is made. Throws Error.
void write_rate_record(const std::filesystem::path& folder, const RateRun&);

}  // namespace airlight::experiments::cli
