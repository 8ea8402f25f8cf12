// Wall time of a repeated job: warm-up, runs, median.
#pragma once
#include <functional>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/statistics.h"
#include "scene/renderer.h"

namespace airlight::experiments {

struct Timing {
  Estimate seconds;     // median, interval by ranks
  double coverage = 0;  // of the interval
  double mad = 0;       // [s], times 1.4826
  int runs = 0;
};

// Runs that are made whatever the budget, unless it is 0, where all of them take less than a second: fewer have no
// interval by ranks worth the name.
inline constexpr int least_runs = 7;

// `first` is the time [s] of a run that was made already: it counts as warm-up, and as the only run if the budget
// allows no other. Rule: warm up until the rule's time is spent or the median of the last runs moves less than 1 %,
// then `runs` (5 where one takes longer than a second), fewer if the budget ends, but `least_runs` of short ones.
Timing time_runs(const TimingRule&, double first, const std::function<void()>& job);

// Times of the stages of several renders, by name in the order of their first appearance.
class StageTimes {
 public:
  // The first render warms up: its times count only if there is no other.
  void add(const std::vector<scene::StageTime>&);
  std::vector<std::pair<std::string, double>> medians() const;  // [s]

 private:
  std::vector<std::vector<scene::StageTime>> runs_;
};

}  // namespace airlight::experiments
