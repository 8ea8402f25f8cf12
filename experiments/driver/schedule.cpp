#include "experiments/driver/schedule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "experiments/application/json_value.h"
#include "experiments/driver/expected_seconds.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/plan.h"
#include "reference/path_tracer/options.h"
#include "reference/path_tracer/tally.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr double second_of_gather = 1;  // [s] of an experiment (it reads rows and draws plots) or a film of ranges

struct Job {
  double seconds = 0;
  std::string id;
  int row = 0;  // from 1, in the order of the table
};

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

// The reference of a scene, and what must be known to plan it.
struct ReferenceFilm {
  std::string scene;
  bool missing = true;
  std::string key;          // empty: its scene cannot be loaded before smoke is simulated
  PlannedFilm size;         // pixels 0: unknown
  double range_bytes = 0;   // of a file with samples of it
  bool has_ranges = false;  // its samples can be shared among tasks
};

ReferenceFilm reference_film(const Experiment& e, const SceneCase& c, const scene::ContentStore& store) {
  ReferenceFilm film;
  film.scene = c.name;
  PlannedScene planned;
  try {
    planned = plan_reference(e, c);
  } catch (const Error&) {
    if (e.sequences.empty()) throw;
    film.missing = !reference_of(e, c).renderer.empty();
    return film;
  }
  film.size.pixels = double(planned.scene->width) * planned.scene->height;
  film.missing = planned.reference && !is_there(planned, store);
  if (!film.missing) return film;
  film.key = reference_key(planned);
  if (planned.reference->monte_carlo()) {
    const path_tracer::Options options = path_tracer::parse_options(*planned.reference_settings);
    film.size.samples = double(options.samples);
    film.has_ranges = options.target_error == 0;
    film.range_bytes = film.size.pixels * path_tracer::TallyLayout{options.orders, true}.doubles() * sizeof(double);
  }
  return film;
}

// Cuts samples into `parts` ranges or more, up to twice as many. All but the last have 2^k samples: their sums are one block of a range file.
std::vector<std::pair<std::uint64_t, std::uint64_t>> sample_ranges(std::uint64_t samples, double parts) {
  const auto even = std::uint64_t(std::max(double(samples) / parts, 1.0));
  const std::uint64_t size = std::max(path_tracer::leaf_samples, std::bit_floor(even));
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
  for (std::uint64_t begin = 0; begin < samples; begin += size)
    ranges.emplace_back(begin, std::min(begin + size, samples));
  return ranges;
}

template <class Work>
std::vector<double> seconds_of(const std::vector<Work>& list) {
  std::vector<double> seconds;
  for (const Work& work : list) seconds.push_back(work.seconds);
  return seconds;
}

struct MissingReference {
  double seconds = 0;  // all its samples
  std::string command;
  ReferenceFilm film;
};

std::vector<ScheduledTask> shared(const std::vector<ScheduledTask>& jobs, const ScheduleOptions& options) {
  std::vector<ScheduledTask> tasks;
  for (const auto& share : balanced(seconds_of(jobs), options.tasks, options.least)) {
    ScheduledTask& task = tasks.emplace_back();
    for (const std::size_t job : share) {
      task.seconds += jobs[job].seconds;
      task.commands.insert(task.commands.end(), jobs[job].commands.begin(), jobs[job].commands.end());
    }
  }
  return tasks;
}

// A reference that takes longer than a fair share of all of them is cut into ranges of samples, and a later stage joins these to its film.
void plan_references(const std::vector<MissingReference>& missing, const ScheduleOptions& options, Stage& references,
                     Stage& films, double& bytes) {
  const std::vector<double> seconds = seconds_of(missing);
  const double all = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  const double fair = std::max(options.least, all / options.tasks);
  std::vector<ScheduledTask> whole_or_range, joins;
  for (const MissingReference& m : missing) {
    const auto samples = std::uint64_t(m.film.size.samples);
    const auto ranges = m.film.has_ranges && m.seconds > fair ? sample_ranges(samples, m.seconds / fair)
                                                              : std::vector{std::pair<std::uint64_t, std::uint64_t>{}};
    if (ranges.size() < 2) {
      whole_or_range.push_back({m.seconds, {m.command}});
      continue;
    }
    for (const auto& [begin, end] : ranges)
      whole_or_range.push_back({m.seconds * double(end - begin) / m.film.size.samples,
                                {fmt::format("{} --samples {}..{}", m.command, begin, end)}});
    joins.push_back({second_of_gather, {m.command}});
    bytes += double(ranges.size()) * m.film.range_bytes;
  }
  references.tasks = shared(whole_or_range, options);
  films.tasks = shared(joins, options);
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
  Stage sequences, references, films, rows, times, gather;
  sequences.name = "sequences", sequences.unknown = true;
  references.name = "references";
  films.name = "films";
  rows.name = "rows";
  times.name = "times", times.alone = true;
  gather.name = "gather";
  const scene::ContentStore store(folders.cache);
  std::vector<Job> row_jobs;
  std::vector<ScheduledTask> timed_runs;
  std::vector<MissingReference> missing;
  std::map<std::string, const Experiment*> by_id;
  std::map<std::string, std::vector<std::string>> journals;  // of each experiment
  std::set<std::string> simulated, wanted;
  for (const Experiment& e : experiments) {
    by_id[e.id] = &e;
    for (const std::string& name : e.sequences)
      if (simulated.insert(name).second)
        sequences.tasks.push_back({0, {fmt::format("simulate --sequence {} --profile {}", name, e.profile)}});
    std::vector<ReferenceFilm> of_scenes;
    std::map<std::string, PlannedFilm> sizes;
    for (const SceneCase& c : e.scenes) {
      if (!e.kind->draws_pictures() || c.frames) continue;
      of_scenes.push_back(reference_film(e, c, store));
      if (of_scenes.back().size.pixels > 0) sizes[c.name] = of_scenes.back().size;
    }
    const ExpectedSeconds expected = expected_seconds(e, folders, sizes);
    if (expected.from == ExpectedSeconds::From::quick_record) plan.scaled.push_back(e.id);
    if (expected.guessed) plan.guessed.push_back(e.id);
    const double slower = std::max(1.0, expected.threads / options.threads);
    for (const ReferenceFilm& film : of_scenes) {
      if (!film.missing || (!film.key.empty() && !wanted.insert(film.key).second)) continue;
      const auto known = expected.references.find(film.scene);
      missing.push_back({known == expected.references.end() ? 0 : slower * known->second,
                         fmt::format("experiment reference {} '{}' --profile {}", e.id, film.scene, e.profile), film});
    }
    plan.rows += expected.once.size();
    // What other kinds say of time is a figure of the row itself.
    const bool timed = e.timing.budget > 0 || !e.kind->times_rows();
    if (timed && !(options.without_times && e.kind->times_rows())) {
      const std::string journal = "times/" + e.id;
      timed_runs.push_back({expected.of_rows(), {run_command(e, "1/1", journal)}});
      journals[e.id].push_back(journal);
      continue;
    }
    for (std::size_t k = 0; k < expected.once.size(); ++k)
      row_jobs.push_back({slower * expected.once[k], e.id, int(k) + 1});
  }

  plan_references(missing, options, references, films, plan.bytes);
  times.tasks = shared(timed_runs, options);
  for (const auto& share : balanced(seconds_of(row_jobs), options.tasks, options.least)) {
    const std::string journal = fmt::format("rows/{}", rows.tasks.size() + 1);
    ScheduledTask& task = rows.tasks.emplace_back();
    std::map<std::string, std::vector<int>> numbers;
    for (const std::size_t job : share) {
      task.seconds += row_jobs[job].seconds;
      numbers[row_jobs[job].id].push_back(row_jobs[job].row);
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
  for (Stage* stage : {&sequences, &references, &films, &rows, &times, &gather})
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
  return {{"experiments", plan.experiments},  {"rows", plan.rows},
          {"scaled_from_quick", plan.scaled}, {"guessed", plan.guessed},
          {"bytes_of_ranges", plan.bytes},    {"stages", stages}};
}

}  // namespace airlight::experiments
