#include "experiments/driver/expected_seconds.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <set>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/driver/agreement.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/time_left.h"
#include "experiments/driver/timing.h"

namespace airlight::experiments {
namespace {

double total(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

struct Record {
  std::vector<Row> rows;
  double row_seconds = 0;                    // of all rows together
  std::map<std::string, double> references;  // [s] by scene
  std::map<std::string, double> samples;     // per pixel, by scene; none for a reference that takes none
  double threads = 1;
};

std::optional<Record> read_record(const std::filesystem::path& file, bool reads_films) {
  const std::optional<std::vector<Row>> rows = recorded_rows(file);
  std::set<std::string> shared;
  const std::optional<PlannedWork> work = recorded_work(file, reads_films, shared);
  if (!rows || !work) return std::nullopt;
  Record record{*rows, work->rows, work->references, {}, 1};
  const nlohmann::json json = read_json(file.string());
  const int asked = json.at("timing").at("threads"), all = json.at("machine").at("threads");
  record.threads = asked > 0 ? asked : all;
  for (const auto& reference : json.at("references")) {
    const std::string samples = reference.value("samples", std::string());
    if (!samples.empty()) record.samples[reference.at("scene").get<std::string>()] = std::stod(samples);
  }
  return record;
}

// Timed runs of a row of which one takes so many seconds (timing.h).
double timed_runs(const TimingRule& rule, double seconds) {
  if (rule.budget <= 0) return 0;
  if (seconds > 1) return std::min(rule.runs, 5);
  return std::clamp(rule.budget / std::max(seconds, 1e-9), double(std::min(least_runs, rule.runs)), double(rule.runs));
}

// What is to be multiplied to get from the recorded row to this one; nothing where they cannot be compared.
using Scale = std::function<std::optional<double>(const SceneCase&, const MethodCase&, const Row&)>;

void fill_rows(const Experiment& e, const std::vector<Row>& recorded, const Scale& scale, ExpectedSeconds& expected) {
  std::vector<std::size_t> unknown;
  std::size_t known = 0;
  for (const SceneCase& c : e.scenes)
    for (const MethodCase& m : e.methods) {
      if (!is_on(m, c)) continue;
      double once = 0, timed = 0;
      const auto found = std::find_if(recorded.begin(), recorded.end(), [&](const Row& row) {
        return row.scene == c.name && row.method == m.name && row.setting == m.setting;
      });
      const std::optional<double> factor = found == recorded.end() ? std::nullopt : scale(c, m, *found);
      if (!factor) {
        unknown.push_back(expected.once.size());
      } else if (found->runs > 0) {  // a refused row takes no time
        const double seconds = *factor * found->seconds.value;
        once = found->prepare_seconds + seconds;
        timed = once + timed_runs(e.timing, seconds) * seconds;
        ++known;
      }
      expected.once.push_back(once);
      expected.timed.push_back(timed);
    }
  const double once = total(expected.once), timed = total(expected.timed);
  for (const std::size_t i : unknown) {
    expected.once[i] = known ? once / double(known) : 1;
    expected.timed[i] = known ? timed / double(known) : 1;
  }
  expected.guessed = !unknown.empty();
}

// [s] All rows as recorded, without what belongs to no row.
double recorded_seconds(const std::vector<Row>& rows) {
  double seconds = 0;
  for (const Row& row : rows)
    if (row.runs > 0) seconds += row.prepare_seconds + (1 + row.runs) * row.seconds.value;
  return seconds;
}

void from_own_record(const Experiment& e, const Record& record, ExpectedSeconds& expected) {
  fill_rows(
      e, record.rows, [](const auto&...) { return 1.0; }, expected);
  const double all = total(expected.timed);
  if (all > 0) {
    for (double& seconds : expected.once) seconds *= record.row_seconds / all;
    for (double& seconds : expected.timed) seconds *= record.row_seconds / all;
  } else {  // figures of rows that nobody timed one by one
    std::fill(expected.timed.begin(), expected.timed.end(), record.row_seconds / double(expected.timed.size()));
    expected.once = expected.timed;
  }
  expected.references = record.references;
}

void from_quick_record(const Experiment& e, const Experiment& quick, const Record& record,
                       const std::map<std::string, PlannedFilm>& films, ExpectedSeconds& expected) {
  std::map<std::string, double> more_pixels;  // by scene
  for (const Row& row : record.rows) {
    const auto film = films.find(row.scene);
    if (row.width > 0 && film != films.end())
      more_pixels[row.scene] = film->second.pixels / (double(row.width) * row.height);
  }
  const auto same = [&](const SceneCase& c, const MethodCase& m) {
    const auto scene = std::find_if(quick.scenes.begin(), quick.scenes.end(),
                                    [&](const SceneCase& other) { return other.name == c.name; });
    const auto method = std::find_if(quick.methods.begin(), quick.methods.end(), [&](const MethodCase& other) {
      return other.name == m.name && other.setting == m.setting;
    });
    return scene != quick.scenes.end() && scene->overrides == c.overrides && method != quick.methods.end() &&
           method->settings == m.settings;
  };
  fill_rows(
      e, record.rows,
      [&](const SceneCase& c, const MethodCase& m, const Row&) -> std::optional<double> {
        if (const auto scale = more_pixels.find(c.name); scale != more_pixels.end()) return scale->second;
        return same(c, m) ? std::optional(1.0) : std::nullopt;
      },
      expected);
  const double of_each = std::max(0.0, record.row_seconds - recorded_seconds(record.rows)) / double(record.rows.size());
  for (double& seconds : expected.once) seconds += of_each;
  for (double& seconds : expected.timed) seconds += of_each;
  for (const auto& [scene, seconds] : record.references) {
    double& all = expected.references[scene] = seconds;
    if (const auto scale = more_pixels.find(scene); scale != more_pixels.end()) all *= scale->second;
    const auto film = films.find(scene);
    const auto samples = record.samples.find(scene);
    if (film != films.end() && film->second.samples > 0 && samples != record.samples.end())
      all *= film->second.samples / samples->second;
  }
}

}  // namespace

double ExpectedSeconds::of_rows() const { return total(timed); }

ExpectedSeconds expected_seconds(const Experiment& e, const Folders& folders,
                                 const std::map<std::string, PlannedFilm>& films) {
  const auto record_of = [&](const std::string& profile) {
    return read_record(folders.root / "results" / results_name(e.id, profile) / "run.json",
                       !e.reference.committed.empty());
  };
  ExpectedSeconds expected;
  if (const std::optional<Record> own = record_of(e.profile)) {
    expected.from = ExpectedSeconds::From::own_record;
    expected.threads = own->threads;
    from_own_record(e, *own, expected);
  } else if (const std::optional<Record> quick = record_of("quick"); quick && !quick->rows.empty()) {
    expected.from = ExpectedSeconds::From::quick_record;
    expected.threads = quick->threads;
    from_quick_record(e, read_experiment(folders, e.id, "quick"), *quick, films, expected);
  } else {
    fill_rows(e, {}, {}, expected);
  }
  return expected;
}

}  // namespace airlight::experiments
