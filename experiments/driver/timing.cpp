#include "experiments/driver/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "experiments/application/machine.h"

namespace airlight::experiments {
namespace {

constexpr double short_job = 0.01;  // [s]

class Runs {
 public:
  Runs(const TimingRule& rule, const TimedJob& job, bool alone, const Clock& clock)
      : rule_(rule),
        job_(job),
        clock_(clock),
        rerun_(!alone && job.first < short_job),
        alone_(alone),
        spent_(job.first) {
    wanted_ = job.first > 1 ? std::min(rule.runs, 5) : rule.runs;
    certain_ = rule.budget > 0 && least_runs * job.first < 1 ? least_runs : 0;
  }

  void warm_up() {
    warm_for(job_.warm_up);
    std::vector<double> times;
    double last_median = job_.first;
    for (double warmed = job_.first; warmed < rule_.least_seconds; warmed += times.back()) {
      times.push_back(once());
      if (times.size() % 20 != 0) continue;
      const double now = median({times.end() - 20, times.end()});
      if (std::abs(now - last_median) < 0.01 * now) break;
      last_median = now;
    }
  }

  bool wants_more() const {
    return int(times_.size()) < wanted_ && (int(times_.size()) < certain_ || spent_ + job_.first <= rule_.budget);
  }

  void run() {
    if (!alone_ && job_.warm_up > 0)
      warm_for(0.05 * job_.warm_up);
    else if (rerun_)
      once();
    const ProcessorTime before = processor_time();
    times_.push_back(once());
    const ProcessorTime after = processor_time();
    ran_ += after.run - before.run;
    waited_ += after.waited - before.waited;
  }

  Timing timing() const {
    const std::vector<double> times = times_.empty() ? std::vector<double>{job_.first} : times_;
    return {median_estimate(times),
            median_ranks(int(times.size())).coverage,
            sigma_per_mad * median_absolute_deviation(times),
            int(times.size()),
            times_,
            waited_ > 0 ? waited_ / (ran_ + waited_) : 0};
  }

 private:
  void warm_for(double seconds) {
    const double before = spent_;
    for (const double start = clock_(); clock_() - start < seconds;) once();
    spent_ = before;
  }

  double once() {
    const double start = clock_();
    job_.run();
    const double seconds = clock_() - start;
    spent_ += seconds;
    return seconds;
  }

  const TimingRule& rule_;
  const TimedJob& job_;
  const Clock& clock_;
  bool rerun_, alone_;
  double spent_, ran_ = 0, waited_ = 0;
  int wanted_ = 0, certain_ = 0;
  std::vector<double> times_;
};

}  // namespace

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<Timing> time_runs(const TimingRule& rule, const std::vector<TimedJob>& jobs, const Clock& clock) {
  std::vector<Runs> all;
  for (const TimedJob& job : jobs) all.emplace_back(rule, job, jobs.size() == 1, clock);
  for (Runs& runs : all) runs.warm_up();
  bool more = true;
  for (std::size_t round = 0; more; ++round) {
    more = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      Runs& runs = all[(round + i) % all.size()];
      if (!runs.wants_more()) continue;
      runs.run();
      more = true;
    }
  }
  std::vector<Timing> timings;
  for (const Runs& runs : all) timings.push_back(runs.timing());
  return timings;
}

Timing time_runs(const TimingRule& rule, double first, const std::function<void()>& job) {
  return time_runs(rule, std::vector<TimedJob>{{first, job}}).front();
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
