// Wall time of repeated jobs: warm-up, rounds, medians.
#pragma once
#include <functional>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/judging/statistics.h"
#include "scene/renderer.h"

namespace airlight::experiments {

struct Timing {
  Estimate seconds;           // median, interval by ranks
  double coverage = 0;        // of the interval
  double mad = 0;             // [s], times 1.4826
  int runs = 0;               // what the times are of
  std::vector<double> times;  // [s], by round; empty where the only run is the one that made the picture
  double waited = 0;          // share of the threads' time in these runs in which no processor was free for them
};

struct TimedJob {
  double first = 0;  // [s] of a run that was made already
  std::function<void()> run;
  double warm_up = 0;  // [s] at least, beside the budget: processors that raise their clock only under load
};

// Runs that are made whatever the budget, unless it is 0, where all of them take less than a second: fewer have no
// interval by ranks worth the name.
inline constexpr int least_runs = 7;

// Seconds from some start.
using Clock = std::function<double()>;
double steady_seconds();

// The jobs in rounds of one run each, so that whatever slows the machine for a while slows them alike; each round
// begins with the next job. The `first` run counts as warm-up, and as the only run if the budget allows no other. Rule,
// for each job: warm up until the rule's time is spent or the median of the last runs moves less than 1 %, then `runs`
// (5 where one takes longer than a second), fewer if the budget ends, but `least_runs` of short ones. Beside others, a
// job of less than 10 ms is run once more, untimed, before each timed run: the others have taken its caches. A job with a
// `warm_up` of its own is run until that is spent, and beside others for a twentieth of it before each timed run.
std::vector<Timing> time_runs(const TimingRule&, const std::vector<TimedJob>&, const Clock& = steady_seconds);
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
