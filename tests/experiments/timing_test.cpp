// How renders are timed: how often, in which order, and what their times say.
#include "experiments/driver/timing.h"

#include <catch2/catch.hpp>

namespace timing_test {

using namespace airlight::experiments;

TEST_CASE("timed runs follow the rule", "[driver]") {
  int count = 0;
  const Timing five = time_runs({5, 0, 2, 0}, 1e-6, [&] { ++count; });
  CHECK(five.runs == 5);
  CHECK(count == 5);
  CHECK(five.coverage == Approx(0.9375));
  const Timing none = time_runs({5, 0, 0.5, 0}, 0.6, [&] { FAIL("the budget is spent"); });
  CHECK(none.runs == 1);
  CHECK(none.seconds.value == 0.6);
  count = 0;
  const Timing least = time_runs({31, 0, 0.1, 0}, 0.12, [&] { ++count; });
  CHECK(least.runs == 7);  // of a short job, though the budget is spent
  CHECK(least.coverage > 0.95);
  CHECK(time_runs({31, 0, 0, 0}, 0.01, [&] { FAIL("there is no budget"); }).runs == 1);
  CHECK(time_runs({5, 0, 0.01, 0}, 0.01, [&] {}).runs == 5);
  count = 0;
  const Timing warmed = time_runs({31, 0.02, 60, 0}, 0, [&] { ++count; });
  CHECK(warmed.runs == 31);
  CHECK(count > 31);  // warm-up runs are not counted
}

// Jobs of more than a second are run 5 times; others as often as asked for, within the budget.
TEST_CASE("how often a job is timed", "[driver]") {
  int count = 0;
  const auto job = [&] { ++count; };
  CHECK(time_runs({31, 0, 60, 0}, 1.01, job).runs == 5);
  CHECK(count == 5);
  CHECK(time_runs({31, 0, 60, 0}, 0.99, job).runs == 31);
  CHECK(time_runs({3, 0, 60, 0}, 1.01, job).runs == 3);
  // 7 runs of 0.14 s take 0.98 s, so they are certain; of 0.15 s 1.05 s, so they are not.
  CHECK(time_runs({31, 0, 0.1, 0}, 0.14, job).runs == 7);
  CHECK(time_runs({31, 0, 0.1, 0}, 0.15, job).runs == 1);
  CHECK(time_runs({31, 0, 0.1, 0}, 0.15, job).seconds.value == 0.15);
}

// A machine whose speed halves while it is watched, by a clock of its own: run k of all takes 1 + k / 60 s for one
// piece of work. Sixty runs of two identical jobs: in turns (A B, B A, A B, ...) both have the median 1 + 29.5 / 60 to
// within one run; one after the other 1 + 14.5 / 60 and 1 + 44.5 / 60, a ratio of 1.40.
TEST_CASE("what slows the machine slows rows that are timed in turns alike", "[driver]") {
  double now = 0;
  int made = 0;
  std::string order;
  const auto job = [&](char name) {
    return TimedJob{0.9, [&, name] {
                      order += name;
                      now += 1 + made++ / 60.0;
                    }};
  };
  const TimingRule rule{30, 0, 1e6, 0};
  const auto timings = time_runs(rule, {job('a'), job('b')}, [&] { return now; });
  REQUIRE(timings.size() == 2);
  CHECK(order.substr(0, 6) == "abbaab");
  CHECK(timings[0].runs == 30);
  CHECK(timings[0].seconds.value == Approx(1 + 29.5 / 60).margin(0.51 / 60));
  CHECK(timings[0].seconds.value / timings[1].seconds.value == Approx(1).margin(0.01));
  CHECK(timings[0].times.size() == 30);
  now = made = 0;
  const auto alone = time_runs(rule, {job('a')}, [&] { return now; });
  const auto after = time_runs(rule, {job('b')}, [&] { return now; });
  CHECK(after[0].seconds.value / alone[0].seconds.value == Approx((1 + 44.5 / 60) / (1 + 14.5 / 60)));
}

TEST_CASE("timed in turns, each job has its own budget, and a short one its caches", "[driver]") {
  double now = 0;
  int slow = 0, quick = 0;
  const TimedJob of_two_seconds{2, [&] { now += 2, ++slow; }}, of_a_millisecond{1e-3, [&] { now += 1e-3, ++quick; }};
  const auto timings = time_runs({31, 0, 9, 0}, {of_two_seconds, of_a_millisecond}, [&] { return now; });
  // 2 s of the first render and three runs are 8 s: the next would pass 9 s.
  CHECK(timings[0].runs == 3);
  CHECK(slow == 3);
  CHECK(timings[1].runs == 31);
  CHECK(quick == 62);  // every other one untimed
  CHECK(timings[1].seconds.value == Approx(1e-3));
}

// By a clock of its own. Warm-up ends at its time, the first render included, or where the median of twenty runs has
// come within 1 % of that before (at first the time of the first render).
TEST_CASE("how long a job is warmed up", "[driver]") {
  double now = 0;
  int made = 0;
  const auto runs_before_timing = [&](double least_seconds, double first, const std::function<double(int)>& takes) {
    now = made = 0;
    const auto timings =
        time_runs({2, least_seconds, 1e6, 0}, {TimedJob{first, [&] { now += takes(made++); }}}, [&] { return now; });
    REQUIRE(timings[0].runs == 2);
    return made - 2;
  };
  const auto second = [](int) { return 1.0; };
  CHECK(runs_before_timing(4, 1, second) == 3);
  CHECK(runs_before_timing(4.5, 1, second) == 4);
  CHECK(runs_before_timing(1, 1, second) == 0);
  CHECK(runs_before_timing(1e6, 1, second) == 20);
  CHECK(runs_before_timing(1e6, 0.9, second) == 40);
  const auto after_twenty = [&](double time) {
    return runs_before_timing(1e6, 5, [time](int run) { return run < 20 ? 4.0 : 4 * time; });
  };
  CHECK(after_twenty(1.0098) == 40);
  CHECK(after_twenty(1.0103) == 60);
  CHECK(after_twenty(0.9903) == 40);
  CHECK(after_twenty(0.9898) == 60);
}

TEST_CASE("a job with a warm-up of its own is run until that is spent, beside the budget", "[driver]") {
  double now = 0;
  int runs = 0;
  const TimedJob gpu{0.125, [&] { now += 0.125, ++runs; }, 1};
  CHECK(time_runs({31, 0, 1, 0}, {gpu}, [&] { return now; })[0].runs == 7);
  CHECK(runs == 8 + 7);
  runs = 0;  // beside another each of the seven is preceded by a twentieth of a second
  const TimedJob other{2, [&] { now += 2; }};
  CHECK(time_runs({31, 0, 1, 0}, {gpu, other}, [&] { return now; })[0].runs == 7);
  CHECK(runs == 8 + 2 * 7);
}

TEST_CASE("jobs at the border of short and long", "[driver]") {
  double now = 0;
  int at = 0, below = 0;
  // Beside another, a job of less than 10 ms finds its caches by a run that is not timed.
  const TimedJob ten_ms{0.01, [&] { now += 0.01, ++at; }}, nine_ms{0.009, [&] { now += 0.009, ++below; }};
  time_runs({31, 0, 9, 0}, {ten_ms, nine_ms}, [&] { return now; });
  CHECK(at == 31);
  CHECK(below == 62);
  CHECK(time_runs({31, 0, 1e6, 0}, {TimedJob{1, [&] { now += 1; }}}, [&] { return now; })[0].runs == 31);
  CHECK(time_runs({31, 0, 1e6, 0}, {TimedJob{1.01, [&] { now += 1; }}}, [&] { return now; })[0].runs == 5);
  // A budget that is reached exactly is not passed: 1 s of the first render and three runs.
  CHECK(time_runs({31, 0, 4, 0}, {TimedJob{1, [&] { now += 1; }}}, [&] { return now; })[0].runs == 3);
}

TEST_CASE("times of stages are medians of the warm runs", "[driver]") {
  StageTimes times;
  CHECK(times.medians().empty());
  times.add({{"a", 9}, {"b", 8}});
  CHECK(times.medians() == std::vector<std::pair<std::string, double>>{{"a", 9}, {"b", 8}});
  times.add({{"a", 1}, {"b", 2}});
  times.add({{"a", 3}, {"b", 7}});
  times.add({{"a", 2}});  // b was left out
  CHECK(times.medians() == std::vector<std::pair<std::string, double>>{{"a", 2}, {"b", 4.5}});
}

// Nine values: the median is the fifth, and the second and the eighth cover it with 1 - 2 (1 + 9) / 2^9 = 0.961.
TEST_CASE("a median and its ranks by hand", "[statistics]") {
  const Estimate e = median_estimate({9, 1, 8, 2, 70, 3, 6, 4, 5});
  CHECK(e.value == 5);
  CHECK(e.low == 2);
  CHECK(e.high == 9);
  CHECK(median_ranks(9).coverage == Approx(1 - 20.0 / 512));
  CHECK(median({4, 1, 2, 9}) == 3);
  CHECK(median_absolute_deviation({1, 2, 4, 9, 10}) == 3);  // of 3, 2, 0, 5, 6
  CHECK_THROWS(median({}));
  CHECK_THROWS(median_ranks(0));
}

}  // namespace timing_test
