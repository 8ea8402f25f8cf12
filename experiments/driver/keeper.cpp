#include "experiments/driver/keeper.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <map>
#include <optional>

#include "experiments/application/folders.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/json_value.h"
#include "experiments/application/machine.h"
#include "experiments/application/probe.h"
#include "experiments/application/progress.h"
#include "experiments/application/say.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/plots.h"
#include "experiments/driver/tables.h"
#include "experiments/driver/timing.h"
#include "gpu/context.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

// Limits on the rows that are held ready at once, so that their timed runs can take turns.
constexpr std::size_t most_held = 16;
constexpr double most_held_gib = 2;

// [s] A GPU raises its clock under load; a processor that plays one is warm.
double gpu_warm_up(const Row& row) { return row.device.empty() || is_processor(row.device) ? 0 : 1; }

bool is_text_of(const fs::path& file, const std::string& text) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::ifstream in(file, std::ios::binary);
  return in && std::string(std::istreambuf_iterator<char>(in), {}) == text;
}

// Progress of an experiment that is run alone.
std::unique_ptr<RunProgress> progress_of(const Experiment& e, const RunOptions& options) {
  auto streams = RunProgress::standard_streams(false);
  if (!options.talk) streams.lines = nullptr;
  auto progress = std::make_unique<RunProgress>(planned_work({e}, options.folders.root / "results"), streams);
  progress->begin(0);
  return progress;
}

std::string processor() {
  const Machine machine = this_machine();
  return fmt::format("{}, {}, {} threads", machine.cpu, machine.simd, machine.threads);
}

// Where and with what a row is made.
std::string computer() { return processor() + " on " + this_node(); }

std::string title_of(const Row& row) {
  std::string title = row.setting.empty() ? row.method : row.method + " " + row.setting;
  return row.scene.empty() ? title : title + " on " + row.scene;
}

}  // namespace

struct RowKeeper::Held {
  std::size_t place = 0;  // among the scene's rows
  MadeRow made;
  StageTimes stages;
};

RowKeeper::RowKeeper(Experiment experiment, const RunOptions& options)
    : options_(options),
      own_progress_(options.progress ? nullptr : progress_of(experiment, options)),
      progress_(options.progress ? *options.progress : *own_progress_),
      store_(options.folders.cache, experiments::say),
      name_(results_name(experiment.id, experiment.profile)),
      journal_(journal_file(options.folders, experiment), options.resume) {
  if (options.folders.default_results()) scene::make_private_folder(store_.folder());  // the journal lies there, too
  outcome_.experiment = std::move(experiment);
  if (options.resume) return;
  journal_.begin_anew();
  fs::remove_all(images() / name_);
}

Outcome RowKeeper::run(const Plan& plan) {
  const double start = steady_seconds();
  bool stopped = false;
  std::optional<Error> failure;
  for (const SceneCase& c : experiment().scenes) {
    try {
      check_interrupted();
      measure(plan(c));
    } catch (const scene::Interrupted&) {
      stopped = true;
      break;
    } catch (const scene::CannotWrite&) {
      throw;  // nor could the tables be written
    } catch (const Error& error) {
      // A scene that cannot be judged takes nothing from the others.
      if (!failure) failure = error;
    }
  }
  outcome_.complete = !stopped && !failure;
  outcome_.seconds = steady_seconds() - start;
  if (options_.gather && !failure && !missing_.empty())
    throw Error(fmt::format("{}: {} of {} rows are missing, the first is '{}'", name_, missing_.size(), planned_,
                            missing_.front()));
  if (options_.gather) judge_times();
  outcome_.gates = judge(outcome_.experiment, outcome_.rows);
  if (!outcome_.rows.empty() && options_.tables) write();
  if (stopped) throw scene::Interrupted("interrupted");
  if (failure) throw Error(*failure);
  return outcome_;
}

std::size_t RowKeeper::row_count() const {
  std::size_t count = 0;
  for (const SceneCase& c : experiment().scenes)
    for (const MethodCase& m : experiment().methods) count += is_on(m, c);
  return count;
}

double RowKeeper::row_work() const { return progress_.work_of_rows() / double(row_count()); }

// The share of timed runs in a row's time is not recorded: half is assumed.
double RowKeeper::making_work() const {
  const bool timed = experiment().kind->times_rows() && experiment().timing.budget > 0;
  return timed ? row_work() / 2 : row_work();
}

RunProgress::Step RowKeeper::reference_step(const SceneCase& c) {
  return {progress_, "reference of " + c.name, progress_.work_of_reference(c.name)};
}

// Rows that are finished are kept; the others are made in groups, and timed in turns.
void RowKeeper::measure(std::vector<RowPlan> plans) {
  std::erase_if(plans, [&](const RowPlan&) {
    ++planned_;
    return options_.share && !options_.share->has(planned_);
  });
  std::vector<std::optional<Row>> rows(plans.size());
  std::exception_ptr failure;
  try {
    std::vector<Held> group;
    double memory = resident_gib();
    std::optional<Error> error;
    for (std::size_t i = 0; i < plans.size() && !error && !rows_end(); ++i) {
      check_interrupted();
      try {
        make(plans[i], i, group, rows);
      } catch (const scene::CannotWrite&) {
        throw;
      } catch (const Error& e) {
        error = e;
      }
      if (group.size() < most_held && resident_gib() - memory < most_held_gib) continue;
      time_group(group, rows);
      memory = resident_gib();
    }
    time_group(group, rows);
    if (error) throw Error(*error);
    if (rows_end()) throw scene::Interrupted("interrupted");
  } catch (...) {
    failure = std::current_exception();
  }
  for (std::optional<Row>& row : rows)
    if (row) outcome_.rows.push_back(std::move(*row));
  if (failure) std::rethrow_exception(failure);
}

// Pictures may have been deleted since: then the row is made again.
bool RowKeeper::has_picture(const Row& row) const {
  return row.image.empty() || fs::exists(images() / (row.image + ".exr"));
}

const Row* RowKeeper::finished(const Row& plan) const {
  const Row* best = journal_.find(plan.key);
  if (best || !options_.gather) return best;
  for (const auto& [key, row] : journal_.rows())
    if (row.figures_key == plan.figures_key && (!best || row.runs > best->runs)) best = &row;
  return best;
}

// A table has the times of one computer, or none.
void RowKeeper::judge_times() {
  std::map<std::string, int> computers;
  std::size_t untimed = 0;
  for (const Row& row : outcome_.rows) {
    if (row.runs > 0)
      ++computers[row.made_on];
    else
      untimed += row.note.empty();
  }
  if (computers.empty() && untimed == 0) return;
  if (computers.size() == 1 && untimed == 0) {
    const std::string& made_on = computers.begin()->first;
    if (!made_on.starts_with(processor() + " on ")) outcome_.made_on = made_on.substr(0, made_on.rfind(" on "));
    return;
  }
  if (!experiment().kind->times_rows()) return;  // what such rows say of time is a figure
  std::vector<std::string> list;
  for (const auto& [name, count] : computers) list.push_back(fmt::format("{} rows on {}", count, name));
  if (untimed > 0) list.push_back(fmt::format("{} rows without times", untimed));
  outcome_.without_times = fmt::format("Times are left out: {}", fmt::join(list, "; "));
  for (Row& row : outcome_.rows) forget_times(row);
  std::erase_if(outcome_.experiment.gates, [](const GateCase& gate) { return judges_time(gate.metric); });
}

void RowKeeper::make(RowPlan& plan, std::size_t place, std::vector<Held>& group,
                     std::vector<std::optional<Row>>& rows) {
  Row row = plan.row;
  if (const Row* kept = finished(row); kept && has_picture(*kept)) {
    rows[place] = *kept;
    rows[place]->parameter = row.parameter;  // only where it is plotted
    progress_.spare(row_work());
    say(*kept, "kept");
    return;
  }
  if (options_.gather) {
    missing_.push_back(title_of(row));
    return;
  }
  RunProgress::Step step(progress_, title_of(row), making_work());
  try {
    Held held{place, plan.make(row, step.execution(experiment().timing.threads)), {}};
    check_interrupted();  // what a stopped run kept is no row
    if (!held.made.again) return finish(held.made.row, rows[place]);
    held.stages.add(held.made.stages);
    group.push_back(std::move(held));
  } catch (const scene::NotSupported& objection) {
    step.spare();
    row.note = "not supported: " + objection.reason;
    finish(row, rows[place]);
  } catch (const Unavailable& reason) {
    step.spare();
    row.note = std::string("not available on this machine: ") + reason.what();  // the others go on
    row.unavailable = dynamic_cast<const NoDataFolder*>(&reason) ||
                      (dynamic_cast<const NoDevice*>(&reason) && !gpu::Context::device_was_chosen());
    rows[place] = row;
    if (options_.share) journal_.add(row);  // else not: the next run may find what is missing
    say(row, "left out");
  }
}

void RowKeeper::time_group(std::vector<Held>& group, std::vector<std::optional<Row>>& rows) {
  if (group.empty()) return;
  const TimingRule& rule = experiment().timing;
  double expected = 0, start = steady_seconds();  // [s]
  for (const Held& held : group) expected += std::min(rule.budget, rule.runs * held.made.first);
  RunProgress::Step step(progress_,
                         fmt::format("timing {}{}", title_of(group.front().made.row),
                                     group.size() > 1 ? fmt::format(" and {} more", group.size() - 1) : ""),
                         double(group.size()) * (row_work() - making_work()));
  const scene::Execution execution = quiet_execution(rule.threads);
  std::vector<TimedJob> jobs;
  for (Held& held : group)
    jobs.push_back({held.made.first,
                    [&, &held = held] {
                      held.stages.add(held.made.again(execution));
                      step.update((steady_seconds() - start) / expected);
                      check_interrupted();
                    },
                    gpu_warm_up(held.made.row)});
  const std::vector<Timing> timings = time_runs(rule, jobs);
  for (std::size_t i = 0; i < group.size(); ++i) {
    Row& row = group[i].made.row;
    const Timing& timing = timings[i];
    row.stages = group[i].stages.medians();
    if (group[i].made.download) row.stages.emplace_back(download_stage, *group[i].made.download);
    row.seconds = timing.seconds;
    row.coverage = timing.coverage;
    row.mad = timing.mad;
    row.runs = timing.runs;
    row.times = timing.times;
    row.waited = timing.waited;
    row.group = group.front().made.row.key;
    finish(row, rows[group[i].place]);
  }
  group.clear();
}

void RowKeeper::finish(Row row, std::optional<Row>& place) {
  row.made_on = computer();
  if (options_.without_times) forget_times(row);
  journal_.add(row);
  made_rows_ = true;
  place = row;
  // A note may also say something about figures that are there.
  say(row, row.note.empty() || !row.measures.empty() || row.runs > 0 ? "done" : "refused");
}

void RowKeeper::say(const Row& row, const char* how) const {
  if (!options_.talk) return;
  const ProgressHidden hidden;
  std::string line = fmt::format("{}:", how);
  for (const std::string& word : {row.scene, row.method, row.setting})
    if (!word.empty()) line += " " + word;
  std::vector<std::string> told;
  if (!row.note.empty()) told.push_back(row.note);
  if (!row.measures.empty()) told.push_back(fmt::format("{} {}", row.measures[0].name, text(row.measures[0])));
  if (row.runs > 0) told.push_back(fmt::format("{:.3g} s", row.seconds.value));
  fmt::print("  {}: {}\n", line, fmt::join(told, ", "));
  std::fflush(stdout);
}

void RowKeeper::write() const {
  const fs::path folder = options_.folders.results / name_;
  make_folder(folder);
  const auto plots = draw_plots(outcome_, folder);
  const std::vector<NamedTable> all = tables(outcome_);
  const nlohmann::json record = run_record(outcome_, all, plots);
  bool changed = made_rows_;
  for (const auto& [name, text] : table_files(outcome_, all, record)) {
    if (is_text_of(folder / name, text)) continue;
    scene::write_file_atomically((folder / name).string(), text);
    changed = true;
  }
  // The record tells of the run that made the tables.
  if (changed || !fs::exists(folder / "run.json"))
    scene::write_file_atomically((folder / "run.json").string(), record.dump(1) + "\n");
}

}  // namespace airlight::experiments
