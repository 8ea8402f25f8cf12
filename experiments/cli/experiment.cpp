#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "experiments/application/folders.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/progress.h"
#include "experiments/application/say.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/experiment_plan.h"
#include "experiments/cli/experiment_runs.h"
#include "experiments/driver/agreement.h"
#include "experiments/driver/committed_references.h"
#include "experiments/driver/expected.h"
#include "experiments/driver/junit.h"
#include "experiments/driver/margins.h"
#include "experiments/driver/plots.h"
#include "experiments/driver/run.h"
#include "experiments/driver/run_progress.h"
#include "experiments/driver/tables.h"
#include "gpu/context.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {

void check_profile(const ExperimentOptions& options) {
  if (options.profile != "quick" && options.profile != "paper")
    throw Error(fmt::format("--profile '{}': expected quick or paper", options.profile));
}

std::string gates_text(const std::vector<GateResult>& gates) {
  const GateCounts counts = count(gates);
  return fmt::format("{} of {} gates ok{}", counts.passed, gates.size(),
                     counts.skipped ? fmt::format(", {} skipped", counts.skipped) : "");
}

Folders folders_of(const ExperimentOptions& options) {
  return {project_root(options.root), options.journal.empty() ? options.results : options.journal, options.cache};
}

std::string shown(const Folders& folders, const std::string& name) {
  return ((folders.default_results() ? "results" : folders.results) / name).string();
}

int name_failures(const std::vector<GateResult>& gates) {
  for (const GateResult& gate : gates)
    if (!gate.passed && !gate.skipped) say("gate failed: " + gate.name);
  return count(gates).failed ? 1 : 0;
}

namespace {

// Tests judge errors: each picture is rendered once, without timed runs, unless a gate judges a time.
void leave_out_times(Experiment& e) {
  for (const GateCase& gate : e.gates)
    if (judges_time(gate.metric)) return;
  e.timing.budget = 0;
}

}  // namespace

std::vector<Experiment> read_and_check(const ExperimentOptions& options, const Folders& folders, bool resume) {
  check_writable(folders.results, "--results names another folder");
  check_writable(folders.cache, "--cache names another folder");
  std::vector<Experiment> experiments;
  for (const std::string& id : choose_experiments(folders.root, options.names)) {
    Experiment e = read_experiment(folders, id, options.profile);
    if (options.gates_only && e.gates.empty()) continue;
    if (options.in_tests && !e.in_tests) continue;
    if (options.threads > 0) e.timing.threads = options.threads;
    if (options.in_tests) leave_out_times(e);
    experiments.push_back(std::move(e));
  }
  Progress progress("checking the experiments");
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    const Experiment& e = experiments[i];
    progress.update(double(i) / double(experiments.size()));
    check_interrupted();
    try {
      RunOptions check{folders, resume, options.threads, false};
      // Trials of all experiments would take a third of the run's time, and the run itself reports the same errors.
      // Parts of an experiment would each try all of it.
      check.trials = !options.in_tests && !options.names.empty() && options.rows.empty() && options.gathered.empty();
      check_experiment(e, check);
    } catch (const Error& error) {
      if (error.exit_code() != 3) throw;  // what this machine lacks takes nothing from the others: the run tells
    }
  }
  return experiments;
}

namespace {

void make_references(const std::vector<Experiment>& experiments, int threads) {
  const std::vector<CommittedReference> references = committed_references(experiments);
  if (references.empty())
    throw Error("--fresh-references: no experiment of this run has committed references (committed_references = true)");
  for (std::size_t i = 0; i < references.size(); ++i) {
    const CommittedReference& r = references[i];
    double seconds = 0;
    {
      Progress progress(fmt::format("reference {} of {}: {}", i + 1, references.size(), r.asked_by));
      seconds = make_committed(r, progress.execution(threads));
    }
    fmt::print("reference {} of {}: {}: {:.1f} s, {} KB: {}/{}\n", i + 1, references.size(), r.asked_by, seconds,
               std::filesystem::file_size(r.file) / 1000, committed_folder, r.file.filename().string());
    std::fflush(stdout);
  }
}

// How runs into a folder of their own compare with the committed tables.
class Agreements {
 public:
  explicit Agreements(const Folders& folders) : folders_(folders) {}

  // One line, and the same counted for the end.
  void tell(const Outcome& outcome) {
    if (folders_.default_results()) return;  // nothing is left to compare with
    const std::string name = results_name(outcome.experiment.id, outcome.experiment.profile);
    try {
      const auto agreement = agreement_with(folders_.root / "results", outcome);
      if (!agreement) {
        ++without_;
        fmt::print("  there is no committed table to compare with\n");
        return;
      }
      ++compared_;
      if (!agreement->agrees()) differ_.push_back(name);
      fmt::print("  {}\n", text(*agreement, "results/" + name));
    } catch (const Error& error) {
      ++without_;
      say(error.what());
    }
  }

  void tell_all() const {
    if (compared_ + without_ == 0) return;
    fmt::print("{} of {} experiments agree with the committed tables{}{}\n", compared_ - differ_.size(), compared_,
               differ_.empty() ? "" : fmt::format("; differs: {}", fmt::join(differ_, ", ")),
               without_ == 0 ? "" : fmt::format("; {} without a committed table", without_));
  }

 private:
  const Folders& folders_;
  std::size_t compared_ = 0, without_ = 0;
  std::vector<std::string> differ_;
};

int list_experiments(const ExperimentOptions& options) {
  check_profile(options);
  const auto root = project_root(options.root);
  const std::vector<std::string> ids = choose_experiments(root, options.names);
  std::size_t widest = 0;
  for (const std::string& id : ids) widest = std::max(widest, id.size());
  std::string lines;
  for (const std::string& id : ids) {
    const Experiment e = read_experiment(root, id, options.profile);
    lines += fmt::format("{:{}}  {}{}{}\n", id, widest, e.title, e.paper.empty() ? "" : "; ", e.paper);
  }
  fmt::print("{}", lines);
  return 0;
}

// All files, scenes and settings are checked before anything is computed; exit code 1 names gates that failed.
int run_experiments(const ExperimentOptions& options) {
  check_profile(options);
  const Folders folders = folders_of(options);
  const std::vector<Experiment> experiments = read_and_check(options, folders, options.resume);
  if (options.fresh_references) make_references(experiments, options.threads);
  std::optional<Error> failure;
  std::vector<GateResult> gates;
  std::vector<std::string> summaries;
  Agreements agreements(folders);
  RunProgress progress(planned_work(experiments, folders.root / "results"));
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    const Experiment& e = experiments[i];
    progress.begin(i);
    try {
      const Outcome outcome = run_experiment(e, {folders, options.resume, options.threads, true, true, &progress});
      const ProgressHidden hidden;
      fmt::print("  {} rows in {:.1f} s, {}: {}/table.md\n", outcome.rows.size(), outcome.seconds,
                 gates_text(outcome.gates), shown(folders, results_name(e.id, e.profile)));
      agreements.tell(outcome);
      gates.insert(gates.end(), outcome.gates.begin(), outcome.gates.end());
      if (!e.summary.empty()) summaries.push_back(summary_text(outcome));
    } catch (const scene::CannotWrite&) {
      throw;  // nor could the others be kept
    } catch (const Error& error) {
      // The others are worth having.
      say(fmt::format("{}: {}", e.id, error.what()));
      if (!failure || error.exit_code() < failure->exit_code()) failure = error;
    }
  }
  progress.end();
  const int code = name_failures(gates);
  agreements.tell_all();
  for (const std::string& summary : summaries) fmt::print("{}\n", summary);
  return failure ? failure->exit_code() : code;
}

int plot_experiments(const ExperimentOptions& options) {
  check_profile(options);
  const Folders folders = folders_of(options);
  bool any = false;
  for (const std::string& id : choose_experiments(folders.root, options.names)) {
    const std::string name = results_name(id, options.profile);
    const std::size_t plots = redraw_plots(read_experiment(folders, id, options.profile), folders.results / name);
    if (plots == 0) continue;
    any = true;
    fmt::print("{}: {} plots\n", name, plots);
  }
  if (!any)
    throw Error(
        fmt::format("no records with plots of these experiments below {}: `airlight experiment run NAME` writes them",
                    folders.results.string()));
  return 0;
}

int write_tables(const ExperimentOptions& options) {
  check_profile(options);
  const Folders folders = folders_of(options);
  bool any = false;
  for (const std::string& id : choose_experiments(folders.root, options.names)) {
    const std::string name = results_name(id, options.profile);
    const auto files = recorded_tables(read_experiment(folders, id, options.profile), folders.results / name);
    if (files.empty()) continue;
    any = true;
    for (const auto& [file, text] : files) scene::write_file_atomically((folders.results / name / file).string(), text);
    fmt::print("{}/table.md\n", shown(folders, name));
  }
  if (!any)
    throw Error(fmt::format("no records of these experiments below {}: `airlight experiment run NAME` writes them",
                            folders.results.string()));
  return 0;
}

int judge_gates(const ExperimentOptions& options, std::vector<GateResult>& results) {
  check_profile(options);
  const Folders folders = folders_of(options);
  // Rows that an earlier run of this program finished are not computed again.
  const std::vector<Experiment> experiments = read_and_check(options, folders, true);
  RunProgress progress(planned_work(experiments, folders.root / "results"), RunProgress::standard_streams(false));
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    const Experiment& e = experiments[i];
    progress.begin(i);
    const std::size_t before = results.size();
    try {
      const Outcome outcome =
          run_experiment(e, {folders, true, options.threads, false, true, &progress, !options.in_tests});
      results.insert(results.end(), outcome.gates.begin(), outcome.gates.end());
    } catch (const scene::CannotWrite&) {
      throw;  // says nothing about accuracy
    } catch (const Error& error) {
      const bool skipped = dynamic_cast<const NoDevice*>(&error) && !gpu::Context::device_was_chosen();
      results.push_back(
          {e.id, fmt::format("{} {}: {}", e.id, skipped ? "is skipped" : "fails", error.what()), false, skipped});
    }
    const ProgressHidden hidden;
    for (std::size_t k = before; !options.margins && k < results.size(); ++k)
      fmt::print("{:7}  {}\n", word(results[k]), results[k].text);
    std::fflush(stdout);
  }
  progress.end();
  if (options.margins) fmt::print("{}", margins_text(results));
  if (!options.margins_csv.empty()) scene::write_file_atomically(options.margins_csv, margins_csv(results));
  if (!options.junit.empty()) write_junit(options.junit, results);
  fmt::print("{}\n", gates_text(results));
  return name_failures(results);
}

// Runs what is not there yet of every experiment that has gates; exit code 1 names those that failed.
int gates(const ExperimentOptions& options) {
  std::vector<GateResult> results;
  try {
    return judge_gates(options, results);
  } catch (const Error& error) {
    // An error that ends the command says nothing about accuracy: it is reported beside the gates that were judged.
    if (!options.junit.empty()) write_junit(options.junit, results, error.what());
    throw;
  } catch (const scene::Interrupted& stop) {
    const std::string line = stopped_by();
    if (!options.junit.empty()) write_junit(options.junit, results, line.empty() ? stop.what() : line.c_str());
    throw;
  }
}

void add_root_and_profile(CLI::App* c, ExperimentOptions& options) {
  c->add_option("--root", options.root,
                "folder of the project (default: found above the current folder, else above the program)");
  c->add_option("--profile", options.profile,
                "quick: small films, a few runs of each row (default); paper: films and runs for publication");
}

void add_selection(CLI::App* c, ExperimentOptions& options) {
  c->add_option("NAME", options.names, "experiments: group/name, or a whole group (default: all)");
  add_root_and_profile(c, options);
}

void add_cache(CLI::App* c, ExperimentOptions& options) {
  c->add_option(
       "--cache", options.cache,
       "folder of references and simulated smoke, which all runs share (default: results/cache/ of the project)")
      ->type_name("FOLDER");
}

void add_results_folder(CLI::App* c, ExperimentOptions& options) {
  c->add_option("--results", options.results,
                "folder of tables, plots, records and pictures (default: results/ of the project)")
      ->type_name("FOLDER");
}

// Adds the options of commands that run experiments.
void add_run(Commands& commands, CLI::App* c, ExperimentOptions& options) {
  add_selection(c, options);
  add_results_folder(c, options);
  add_cache(c, options);
  c->add_option("--threads", options.threads, "number of threads (default 0: all)")->check(CLI::Range(0, 4096));
  commands.add_limit(c);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.add_unchecked(c);
}

}  // namespace

void add_experiment(Commands& commands) {
  const auto options = std::make_shared<ExperimentOptions>();
  CLI::App* experiment = add_command(commands.app, "experiment", "run the experiments behind the tables and plots");
  CLI::App* list = add_command(*experiment, "list", "list the experiments with their titles");
  add_selection(list, *options);
  commands.on(list, [options] { return list_experiments(*options); });
  CLI::App* run = add_command(*experiment, "run",
                              "run experiments and write their tables, plots and pictures; exit 1 if a gate fails");
  add_run(commands, run, *options);
  run->add_flag("--resume", options->resume,
                "continue an interrupted run: keep the rows that this program finished in this results folder");
  run->add_flag("--fresh-references", options->fresh_references,
                "first compute the committed references of these experiments anew and replace their films in "
                "experiments/data/references");
  run->add_option(
      "--rows", options->rows,
      "compute only these rows of one experiment, for computers that share the work: I/N is part I of N, "
      "every N-th row; 3,5-9 are rows by their number; SIGUSR1 ends it after the row in hand with exit code "
      "130, and the same command goes on");
  run->add_option("--journal", options->journal, "folder of the rows and pictures of this part, for --rows")
      ->type_name("FOLDER");
  run->add_flag("--without-times", options->without_times,
                "with --rows: render each picture once and keep no times, since other work may disturb them");
  commands.on(run, [options] {
    if (options->without_times && options->rows.empty()) throw Error("--without-times needs --rows");
    return options->rows.empty() && options->journal.empty() ? run_experiments(*options) : run_part(*options);
  });
  CLI::App* gathered =
      add_command(*experiment, "gather", "write the tables of an experiment whose rows were computed in parts");
  gathered->add_option("NAME", options->gathered, "the experiment: group/name (required)");
  gathered->add_option("FOLDER", options->parts, "folders that --journal named (required)");
  add_root_and_profile(gathered, *options);
  add_results_folder(gathered, *options);
  add_cache(gathered, *options);
  gathered->add_option("--threads", options->threads, "number of threads that the parts had (default 0: all)")
      ->check(CLI::Range(0, 4096));
  commands.add_data(gathered);
  commands.add_gpu(gathered);
  commands.on(gathered, [options] {
    options->names = {options->gathered};
    return gather(*options);
  });
  add_plan(commands, *experiment);
  add_reference(commands, *experiment);
  CLI::App* plot = add_command(*experiment, "plot", "draw the plots of finished experiments again from their data");
  add_selection(plot, *options);
  add_results_folder(plot, *options);
  commands.on(plot, [options] { return plot_experiments(*options); });
  CLI::App* tables = add_command(*experiment, "tables",
                                 "write the tables of finished experiments again from their records, after an edit of "
                                 "claims or titles");
  add_selection(tables, *options);
  add_results_folder(tables, *options);
  commands.on(tables, [options] { return write_tables(*options); });
}

void add_gates(Commands& commands) {
  const auto options = std::make_shared<ExperimentOptions>();
  options->gates_only = true;
  CLI::App* c =
      add_command(commands.app, "gates", "check the accuracy bounds (gates) of the experiments; exit 1 if one fails");
  add_run(commands, c, *options);
  c->add_option("--junit", options->junit, "also write a JUnit report to this file")->type_name("FILE");
  c->add_flag("--margins", options->margins,
              "list how many times worse each figure could be before its gate fails, the loosest first");
  c->add_option("--margins-csv", options->margins_csv, "write those margins to this CSV file")->type_name("FILE");
  c->add_flag(
      "--in-tests", options->in_tests,
      "only experiments that say in_tests = true, as scripts/test does; without timed runs unless a gate judges a "
      "time, and without tables");
  commands.on(c, [options] { return gates(*options); });
}

}  // namespace airlight::experiments::cli
