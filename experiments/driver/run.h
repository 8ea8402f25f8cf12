// Runs an experiment: references, methods, errors, times; then tables, plots, pictures and the record.
#pragma once
#include <filesystem>
#include <optional>
#include <set>

#include "experiments/application/folders.h"
#include "experiments/driver/outcome.h"

namespace airlight::experiments {

class RunProgress;

// Some rows of the table, numbered from 1 in its order, and no tables: every parts-th from `part` on, or those listed.
struct RowShare {
  int part = 1, parts = 1;
  std::set<int> numbers = {};  // empty: every parts-th

  bool has(int number) const { return numbers.empty() ? number % parts == part % parts : numbers.contains(number); }
};

struct RunOptions {
  Folders folders;
  bool resume = false;
  int threads = 0;                  // 0: what the experiment says
  bool talk = true;                 // one line per row on standard output
  bool checked = false;             // check_experiment has found no fault
  RunProgress* progress = nullptr;  // where this experiment has begun; null: of its own
  bool tables = true;               // false: only gates are wanted, so no tables, plots and record are written
  bool trials = true;               // check_experiment renders small pictures; false: it loads and plans alone
  std::optional<RowShare> share = {};
  bool without_times = false;  // rows of this run keep no time: other work may disturb it
  // Every row must be finished, on a processor of any kind: throws Error that says how many are missing, and writes
  // nothing. Times are kept if they all come from one computer.
  bool gather = false;
};

// Checks before anything is written whether the experiment can be computed as its file says. Simulates
// the sequences that its scenes show and loads every scene with its overrides. Tries everything that is
// not finished on a film of at most 8x8 pixels: the reference on every scene, each method on its first
// scene, then the metrics, on the layers that they use. With options.resume, rows of an earlier run
// count as finished. Throws Error in one line that begins with the experiment. Parts that this machine
// lacks are not tried. Without options.trials everything is loaded and planned, nothing rendered.
void check_experiment(const Experiment&, const RunOptions&);

// Writes below folders.results (results_name) and folders.cache. Throws Error, and writes nothing, where check_experiment objects.
// Interrupted: writes what is finished, then throws scene::Interrupted. A scene that fails all the same is left out,
// the others are computed and written, then its Error is thrown. Without a row nothing is written: older tables stay.
Outcome run_experiment(Experiment, const RunOptions&);

// Rows that were finished by runs of this experiment and profile.
std::filesystem::path journal_file(const Folders&, const Experiment&);

}  // namespace airlight::experiments
