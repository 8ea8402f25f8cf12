// Wall time of a repeated job: warm-up, runs, median.
#pragma once
#include <functional>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/statistics.h"

namespace airlight::experiments {

struct Timing {
  Estimate seconds;     // median, interval by ranks
  double coverage = 0;  // of the interval
  double mad = 0;       // [s], times 1.4826
  int runs = 0;
};

// `first` is the time of a run that was made already: it counts as warm-up, and as the only run if the budget is spent.
// Rule: warm up until the rule's time is spent or the median of the last runs moves less than 1 %, then at least
// `runs` (5 where one takes longer than a second), fewer if the budget ends.
Timing time_runs(const TimingRule&, double first, const std::function<void()>& job);

}  // namespace airlight::experiments
