// What the commands that run experiments share.
#pragma once
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/driver/outcome.h"

namespace airlight::experiments::cli {

struct ExperimentOptions {
  std::string root, profile = "quick", junit, margins_csv;
  std::string results, cache;  // folders; empty: results and results/cache below root
  std::vector<std::string> names;
  bool resume = false;
  bool gates_only = false;         // experiments without gates are left out
  bool in_tests = false;           // experiments without in_tests = true are left out
  bool margins = false;            // how far each gate is from failing
  std::string rows, journal;       // of a part: "I/N" or "3,5-9", and the folder of its rows and pictures
  bool without_times = false;      // its rows keep no time
  std::string gathered;            // an experiment
  std::vector<std::string> parts;  // folders of parts that are gathered
  bool fresh_references = false;   // first makes all committed references of these experiments anew
  int threads = 0;
};

// Throws Error for a profile that does not exist.
void check_profile(const ExperimentOptions&);

Folders folders_of(const ExperimentOptions&);

// "5 of 6 gates ok, 1 skipped"
std::string gates_text(const std::vector<GateResult>&);

// The path of a table's folder as a user would type it.
std::string shown(const Folders&, const std::string& name);

// Names gates that failed: 1 if one did, else 0.
int name_failures(const std::vector<GateResult>&);

// All of them, before the first is computed. Only those with gates where these are all that is asked for. Throws Error.
std::vector<Experiment> read_and_check(const ExperimentOptions&, const Folders&, bool resume);

// Some rows of one experiment, into a journal of its own that `gather` reads. Goes on with a journal that is there.
int run_part(const ExperimentOptions&);

// Tables of one experiment from parts that were computed anywhere with this program.
int gather(const ExperimentOptions&);

}  // namespace airlight::experiments::cli
