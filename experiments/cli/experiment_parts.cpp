// Parts of an experiment, and its table from all of them.
#include <fmt/format.h>

#include <cstdio>

#include "experiments/application/interrupt.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/experiment_runs.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/parts.h"
#include "experiments/driver/run.h"
#include "experiments/driver/run_progress.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

// "I/N", I from 1 to N, or row numbers "3,5-9". Throws Error for anything else.
RowShare share_of(const std::string& text) {
  const Error fault(fmt::format("--rows '{}': expected I/N with I from 1 to N, e.g. 2/8, or rows such as 3,5-9", text));
  RowShare share;
  int end = 0;
  if (std::sscanf(text.c_str(), "%6d/%6d%n", &share.part, &share.parts, &end) == 2) {
    if (end != int(text.size()) || share.part < 1 || share.part > share.parts) throw Error(fault);
    return share;
  }
  const char* at = text.c_str();
  do {
    int first = 0, last = 0, length = 0;
    if (std::sscanf(at, "%6d%n", &first, &length) != 1) throw Error(fault);
    at += length;
    last = first;
    if (*at == '-') {
      if (std::sscanf(at, "-%6d%n", &last, &length) != 1) throw Error(fault);
      at += length;
    }
    if (first < 1 || last < first) throw Error(fault);
    for (int number = first; number <= last; ++number) share.numbers.insert(number);
  } while (*at++ == ',');
  if (at[-1] != 0) throw Error(fault);
  return share;
}

}  // namespace

int run_part(const ExperimentOptions& options) {
  check_profile(options);
  if (options.rows.empty() || options.journal.empty())
    throw Error("--rows and --journal FOLDER belong together: one of them is missing");
  if (!options.results.empty() || options.fresh_references)
    throw Error("--rows: --results and --fresh-references are not for parts of an experiment");
  const RowShare share = share_of(options.rows);
  if (options.names.size() != 1) throw Error("--rows: expected one experiment, group/name");
  const Folders folders = folders_of(options);
  catch_end_of_rows();
  std::vector<Experiment> experiments = read_and_check(options, folders, true);
  if (experiments.size() != 1)
    throw Error(fmt::format("--rows: expected one experiment, found {}", experiments.size()));
  if (options.without_times && experiments.front().kind->times_rows()) experiments.front().timing.budget = 0;
  RunProgress progress(planned_work(experiments, folders.root / "results"));
  progress.begin(0);
  RunOptions run{folders, true, options.threads, true, true, &progress, false};
  run.share = share;
  run.without_times = options.without_times && experiments.front().kind->times_rows();
  const Outcome outcome = run_experiment(std::move(experiments.front()), run);
  progress.end();
  fmt::print("  {} rows of part {}: {}\n", outcome.rows.size(), options.rows,
             journal_file(folders, outcome.experiment).string());
  return 0;
}

int gather(const ExperimentOptions& options) {
  check_profile(options);
  require(options.gathered, "NAME");
  if (options.parts.empty()) throw Error("FOLDER is missing; see --help");
  const Folders folders = folders_of(options);
  std::vector<Experiment> experiments = read_and_check(options, folders, true);
  if (experiments.size() != 1)
    throw Error(fmt::format("gather: expected one experiment, found {}", experiments.size()));
  const Experiment& e = experiments.front();
  take_over_parts(folders, e, options.parts);
  RunOptions run{folders, true, options.threads, false, true};
  run.gather = true;
  const Outcome outcome = run_experiment(e, run);
  if (!outcome.without_times.empty()) fmt::print("{}\n", outcome.without_times);
  fmt::print("{} rows of {} folders, {}: {}/table.md\n", outcome.rows.size(), options.parts.size(),
             gates_text(outcome.gates), shown(folders, results_name(e.id, e.profile)));
  return name_failures(outcome.gates);
}

}  // namespace airlight::experiments::cli
