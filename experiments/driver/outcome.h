// Outcome of an experiment's run: rows, their references, gates.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/driver/row.h"

namespace airlight::experiments {

struct ReferenceInfo {
  std::string scene, key, renderer, settings, image;
  double seconds = 0;
  bool cached = false;
  double exposure = 0;
  std::string samples;  // that a Monte Carlo reference has: a cache may hold more than were asked for
  // For a committed film: its file below the project's root, the program that made it, and what the file keeps of it.
  std::string committed = {}, program = {}, kept = {};
};

struct GateResult {
  std::string name;  // "fogshop/fig4: f100, P: rel_l2"
  std::string text;  // with figures
  bool passed = false;
  bool skipped = false;  // neither passed nor failed: the row is unavailable on this machine
  // Columns of margins.h.
  std::string scene = {}, method = {}, setting = {}, metric = {};  // empty where the gate judges no row
  std::string position = {};                                       // of the [[gate]]: file:line:column
  std::string kind = {};                                           // "deterministic", "Monte Carlo", "counter", "time"
  bool upper = true;                                               // at_most; else at_least
  double bound = 0;
  std::optional<Estimate> measured = {};  // nothing where the figure is not defined
  double seconds = 0;                     // [s] of the row that it judges: one render and its preparation
};

// How many passed, failed and were skipped.
struct GateCounts {
  std::size_t passed = 0, failed = 0, skipped = 0;
};
GateCounts count(const std::vector<GateResult>&);
const char* word(const GateResult&);  // ok, skipped or FAILED
bool judges_time(const std::string& metric);

struct Outcome {
  Experiment experiment;
  std::vector<Row> rows;
  std::vector<Row> histories;  // of sequences that scenes show: columns alone, for plots
  std::vector<ReferenceInfo> references;
  std::vector<GateResult> gates;
  bool complete = false;  // false: interrupted
  // Gathered rows: the kind of processor that made all of them if it is not this one, and why no row has a time.
  std::string made_on = {}, without_times = {};
  double seconds = 0;
};

// Each gate against every row that it names: fails if the whole interval lies beyond the bound, if the figure is not
// defined, and if there is no such row. Skipped if the row is unavailable on this machine. Where a bound by row
// (bounds.h) was measured on the same device it stands for that of the [[gate]]; a figure without any bound fails.
std::vector<GateResult> judge(const Experiment&, const std::vector<Row>&);

}  // namespace airlight::experiments
