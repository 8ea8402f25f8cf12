#include "experiments/driver/time_left.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr double trusted_work = 10;           // [s]
constexpr double unknown_experiment = 15;     // [s] where there is no record at all
constexpr double least_experiment = 0.1;      // [s]
constexpr double share_that_is_enough = 0.1;  // to say from it how long the whole piece takes

}  // namespace

void TimeLeft::done(double piece, double seconds) {
  if (piece <= 0) return;
  done_ += piece;
  seconds_ += seconds;
}

double TimeLeft::slowness() const { return (seconds_ + trusted_work) / (done_ + trusted_work); }

double TimeLeft::left(double piece, double share, double seconds) const {
  const double rest = std::max(0.0, work_ - done_ - spared_ - piece);
  const double of_piece = share >= share_that_is_enough && seconds > 1 ? seconds * (1 - share) / share
                                                                       : std::max(0.0, slowness() * piece - seconds);
  return slowness() * rest + of_piece;
}

std::string time_left_text(double seconds) {
  if (seconds < 10) return "a few seconds left";
  if (seconds < 90) return fmt::format("about {:.0f} s left", 10 * std::round(seconds / 10));
  const double minutes = std::round(seconds / 60);
  if (minutes < 90) return fmt::format("about {:.0f} min left", minutes);
  return fmt::format("about {:.0f} h {:02.0f} min left", std::floor(minutes / 60), std::fmod(minutes, 60));
}

double PlannedWork::total() const {
  double sum = rows;
  for (const auto& [scene, seconds] : references) sum += seconds;
  return sum;
}

std::optional<PlannedWork> recorded_work(const std::filesystem::path& file, bool reads_films,
                                         std::set<std::string>& shared) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  PlannedWork work;
  try {
    const nlohmann::json record = read_json(file.string());
    work.rows = record.at("seconds").get<double>();
    for (const auto& reference : record.at("references")) {
      // A film that was read has the seconds of its making, which the run did not take.
      if (!reference.value("committed", std::string()).empty()) continue;
      const double seconds = reference.at("seconds").get<double>();
      if (!reference.at("from_cache").get<bool>()) work.rows -= seconds;
      if (!reads_films && shared.insert(reference.at("key").get<std::string>()).second)
        work.references[reference.at("scene").get<std::string>()] += seconds;
    }
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
  work.rows = std::max(work.rows, least_experiment);
  return work;
}

std::vector<PlannedWork> planned_work(const std::vector<Experiment>& experiments,
                                      const std::filesystem::path& results) {
  std::vector<PlannedWork> all;
  std::set<std::string> shared;
  double sum = 0;
  int known = 0;
  for (const Experiment& e : experiments) {
    const auto found =
        recorded_work(results / results_name(e.id, e.profile) / "run.json", !e.reference.committed.empty(), shared);
    all.push_back(found.value_or(PlannedWork{}));
    all.back().name = fmt::format("{} ({})", e.id, e.profile);
    sum += all.back().total();
    known += found.has_value();
  }
  for (PlannedWork& work : all)
    if (work.rows == 0) work.rows = known ? sum / known : unknown_experiment;
  return all;
}

}  // namespace airlight::experiments
