#include "experiments/driver/schedule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/driver/agreement.h"
#include "experiments/driver/committed_references.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/reference_cache.h"
#include "experiments/driver/time_left.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr double second_of_gather = 1;  // [s] of an experiment: it reads rows and draws plots

struct Job {
  double seconds = 0;
  std::string id;
  int row = 0;  // from 1, in the order of the table
};

// [s] of each row in the order of the table: one run with its preparation, and all timed runs. They add up to `total`.
struct RowSeconds {
  std::vector<double> once, timed;
};

RowSeconds row_seconds(const Experiment& e, const std::vector<Row>& recorded, double total) {
  RowSeconds rows;
  std::vector<std::size_t> unknown;
  for (const SceneCase& c : e.scenes)
    for (const MethodCase& m : e.methods) {
      if (!is_on(m, c)) continue;
      const auto found = std::find_if(recorded.begin(), recorded.end(), [&](const Row& row) {
        return row.scene == c.name && row.method == m.name && row.setting == m.setting && row.runs > 0;
      });
      if (found == recorded.end()) {
        unknown.push_back(rows.once.size());
        rows.once.push_back(0);
        rows.timed.push_back(0);
        continue;
      }
      rows.once.push_back(found->prepare_seconds + found->seconds.value);
      rows.timed.push_back(rows.once.back() + found->runs * found->seconds.value);
    }
  const auto sum = [](const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); };
  const std::size_t known = rows.once.size() - unknown.size();
  for (const std::size_t i : unknown) {
    rows.once[i] = known ? sum(rows.once) / double(known) : 1;
    rows.timed[i] = known ? sum(rows.timed) / double(known) : 1;
  }
  const double scale = sum(rows.timed) > 0 ? total / sum(rows.timed) : 0;
  for (std::size_t i = 0; i < rows.once.size(); ++i) rows.once[i] *= scale, rows.timed[i] *= scale;
  return rows;
}

// Threads that the record's run had, over those of a task.
double fewer_threads(const std::filesystem::path& file, int threads) {
  const nlohmann::json record = read_json(file.string());
  const int asked = record.at("timing").at("threads"), all = record.at("machine").at("threads");
  return std::max(1.0, double(asked > 0 ? asked : all) / threads);
}

// "1,4-6"
std::string ranges(const std::vector<int>& numbers) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    parts.push_back(end == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[end]));
    i = end + 1;
  }
  return fmt::format("{}", fmt::join(parts, ","));
}

std::string run_command(const Experiment& e, const std::string& rows, const std::string& journal) {
  return fmt::format("experiment run {} --profile {} --rows {} --journal \"$work/{}\"", e.id, e.profile, rows, journal);
}

// A scene whose smoke is not simulated yet cannot be loaded: its reference counts as missing.
bool is_missing(const Experiment& e, const SceneCase& c, const scene::ContentStore& store) {
  PlannedScene planned;
  try {
    planned = plan_reference(e, c);
  } catch (const Error&) {
    if (e.sequences.empty()) throw;
    return !reference_of(e, c).renderer.empty();
  }
  if (!planned.reference || is_committed(planned.committed)) return false;
  const std::string key =
      reference_key(*planned.scene, *planned.reference, *planned.reference_settings, planned.committed);
  return !store.find("references/" + key + ".exr");
}

}  // namespace

std::vector<std::vector<std::size_t>> balanced(const std::vector<double>& seconds, int tasks, double least) {
  const double total = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  const auto most = std::size_t(std::clamp(std::ceil(total / least), 1.0, double(tasks)));
  std::vector<std::vector<std::size_t>> shares(std::min(most, seconds.size()));
  std::vector<double> loads(shares.size());
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return seconds[a] > seconds[b]; });
  for (const std::size_t job : order) {
    const auto least_loaded = std::size_t(std::min_element(loads.begin(), loads.end()) - loads.begin());
    shares[least_loaded].push_back(job);
    loads[least_loaded] += seconds[job];
  }
  for (auto& share : shares) std::sort(share.begin(), share.end());
  return shares;
}

double Stage::seconds() const {
  double sum = 0;
  for (const ScheduledTask& task : tasks) sum += task.seconds;
  return sum;
}

double Stage::longest() const {
  double longest = 0;
  for (const ScheduledTask& task : tasks) longest = std::max(longest, task.seconds);
  return longest;
}

Schedule schedule(const std::vector<Experiment>& experiments, const Folders& folders, const ScheduleOptions& options) {
  Schedule plan;
  plan.experiments = experiments.size();
  Stage sequences, references, rows, times, gather;
  sequences.name = "sequences", sequences.unknown = true;
  references.name = "references";
  rows.name = "rows";
  times.name = "times", times.alone = true;
  gather.name = "gather";
  const std::vector<PlannedWork> work = planned_work(experiments, folders.root / "results");
  const scene::ContentStore store(folders.cache);
  std::vector<Job> jobs, films;
  std::map<std::string, const Experiment*> by_id;
  std::map<std::string, std::vector<std::string>> journals;  // of each experiment
  std::set<std::string> simulated;
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    const Experiment& e = experiments[i];
    by_id[e.id] = &e;
    const auto record = folders.root / "results" / results_name(e.id, e.profile) / "run.json";
    const std::optional<std::vector<Row>> recorded = recorded_rows(record);
    if (!recorded) plan.guessed.push_back(e.id);
    for (const std::string& name : e.sequences)
      if (simulated.insert(name).second)
        sequences.tasks.push_back({0, {fmt::format("simulate --sequence {} --profile {}", name, e.profile)}});
    for (const SceneCase& c : e.scenes) {
      if (!e.kind->draws_pictures() || c.frames || !is_missing(e, c, store)) continue;
      const auto known = work[i].references.find(c.name);
      films.push_back({known == work[i].references.end() ? 0 : known->second,
                       fmt::format("experiment reference {} '{}' --profile {}", e.id, c.name, e.profile), 0});
    }
    const RowSeconds seconds = row_seconds(e, recorded.value_or(std::vector<Row>{}), work[i].rows);
    plan.rows += seconds.once.size();
    // What other kinds say of time is a figure of the row itself.
    const bool timed = e.timing.budget > 0 || !e.kind->times_rows();
    if (timed && !(options.without_times && e.kind->times_rows())) {
      const std::string journal = "times/" + e.id;
      times.tasks.push_back({work[i].rows, {run_command(e, "1/1", journal)}});
      journals[e.id].push_back(journal);
      continue;
    }
    const double slower = recorded ? fewer_threads(record, options.threads) : 1;
    for (std::size_t k = 0; k < seconds.once.size(); ++k) jobs.push_back({slower * seconds.once[k], e.id, int(k) + 1});
  }

  const auto seconds_of = [](const std::vector<Job>& list) {
    std::vector<double> seconds;
    for (const Job& job : list) seconds.push_back(job.seconds);
    return seconds;
  };
  for (const auto& share : balanced(seconds_of(films), options.tasks, options.least)) {
    ScheduledTask& task = references.tasks.emplace_back();
    for (const std::size_t job : share) {
      task.seconds += films[job].seconds;
      task.commands.push_back(films[job].id);
    }
  }
  for (const auto& share : balanced(seconds_of(jobs), options.tasks, options.least)) {
    const std::string journal = fmt::format("rows/{}", rows.tasks.size() + 1);
    ScheduledTask& task = rows.tasks.emplace_back();
    std::map<std::string, std::vector<int>> numbers;
    for (const std::size_t job : share) {
      task.seconds += jobs[job].seconds;
      numbers[jobs[job].id].push_back(jobs[job].row);
    }
    for (const auto& [id, list] : numbers) {
      const std::string without = by_id.at(id)->timing.budget > 0 ? " --without-times" : "";
      task.commands.push_back(run_command(*by_id.at(id), ranges(list), journal) + without);
      journals[id].push_back(journal);
    }
  }
  const std::vector<double> gathering(experiments.size(), second_of_gather);
  for (const auto& share : balanced(gathering, options.tasks, options.least)) {
    ScheduledTask& task = gather.tasks.emplace_back();
    for (const std::size_t i : share) {
      const Experiment& e = experiments[i];
      std::string& command = task.commands.emplace_back(
          fmt::format("experiment gather {} --profile {} --results \"$work/results\"", e.id, e.profile));
      for (const std::string& journal : journals[e.id]) command += fmt::format(" \"$work/{}\"", journal);
      task.seconds += second_of_gather;
    }
  }
  for (Stage* stage : {&sequences, &references, &rows, &times, &gather})
    if (!stage->tasks.empty()) plan.stages.push_back(std::move(*stage));
  return plan;
}

nlohmann::json to_json(const Schedule& plan) {
  nlohmann::json stages = nlohmann::json::array();
  for (const Stage& stage : plan.stages) {
    nlohmann::json tasks = nlohmann::json::array();
    for (const ScheduledTask& task : stage.tasks)
      tasks.push_back({{"seconds", task.seconds}, {"commands", task.commands}});
    stages.push_back({{"name", stage.name}, {"alone", stage.alone}, {"tasks", tasks}});
  }
  return {{"experiments", plan.experiments}, {"rows", plan.rows}, {"without_record", plan.guessed}, {"stages", stages}};
}

}  // namespace airlight::experiments
