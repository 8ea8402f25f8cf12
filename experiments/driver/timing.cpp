#include "experiments/driver/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace airlight::experiments {
namespace {

double once(const std::function<void()>& job) {
  const auto start = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Timing time_runs(const TimingRule& rule, double first, const std::function<void()>& job) {
  double warmed = first, spent = first;
  std::vector<double> warm_up;
  double last_median = first;
  while (warmed < rule.least_seconds) {
    warm_up.push_back(once(job));
    warmed += warm_up.back();
    spent += warm_up.back();
    if (warm_up.size() % 20 != 0) continue;
    const double now = median({warm_up.end() - 20, warm_up.end()});
    if (std::abs(now - last_median) < 0.01 * now) break;
    last_median = now;
  }
  const int wanted = first > 1 ? std::min(rule.runs, 5) : rule.runs;
  const int certain = rule.budget > 0 && least_runs * first < 1 ? least_runs : 0;
  std::vector<double> times;
  while (int(times.size()) < wanted && (int(times.size()) < certain || spent + first <= rule.budget)) {
    times.push_back(once(job));
    spent += times.back();
  }
  if (times.empty()) times.push_back(first);
  return {median_estimate(times), median_ranks(int(times.size())).coverage,
          sigma_per_mad * median_absolute_deviation(times), int(times.size())};
}

void StageTimes::add(const std::vector<scene::StageTime>& times) { runs_.push_back(times); }

std::vector<std::pair<std::string, double>> StageTimes::medians() const {
  std::vector<std::pair<std::string, double>> result;
  if (runs_.empty()) return result;
  const std::size_t first = runs_.size() > 1 ? 1 : 0;
  for (const scene::StageTime& stage : runs_[first]) {
    std::vector<double> seconds;
    for (std::size_t run = first; run < runs_.size(); ++run)
      for (const scene::StageTime& t : runs_[run])
        if (t.name == stage.name) seconds.push_back(t.seconds);
    result.emplace_back(stage.name, median(seconds));
  }
  return result;
}

}  // namespace airlight::experiments
