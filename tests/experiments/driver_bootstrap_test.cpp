// Intervals of speed-ups from runs and errors drawn again, and what is said of a loaded machine.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/driver/bootstrap.h"
#include "experiments/driver/comparisons.h"

namespace driver_bootstrap_test {

using namespace airlight::experiments;

namespace {

// Times of 15 rounds on a machine that is up to three times slower in some than in others, times `factor`.
Row timed_row(double factor, const std::string& group, std::size_t first = 0) {
  Row row;
  row.runs = 15;
  row.group = group;
  for (std::size_t k = 0; k < 15; ++k) row.times.push_back(factor * (1 + double((7 * k + first) % 15) / 7));
  row.seconds = median_estimate(row.times);
  row.measures = {{"rel_l2", 0.1, 0.1, 0.1, 0, false}};
  return row;
}

// Ratio of times of two rows with equal errors.
std::optional<Estimate> ratio_of_times(const Row& baseline, const Row& other) {
  return bootstrap({&baseline}, {&other}, "rel_l2",
                   [](const auto& a, const auto& b) { return std::optional(a[0].time.value / b[0].time.value); });
}

}  // namespace

// In every round the second row takes half as long: so does its median in any rounds that are drawn for both.
TEST_CASE("a speed-up of rows timed together does not feel what slowed both", "[driver]") {
  const auto paired = ratio_of_times(timed_row(2, "g"), timed_row(1, "g"));
  REQUIRE(paired);
  CHECK(paired->value == Approx(2));
  CHECK(paired->low == Approx(2));
  CHECK(paired->high == Approx(2));
  // Timed apart, nothing is known of which rounds belong together. The middle 95 % of the median of 15 times that are
  // evenly spread over [1, 3] lie about 1.5 to 2.5 (ranks 4 to 12): the ratio of two of them spans more than 1.4
  // to 2.8.
  const auto apart = ratio_of_times(timed_row(2, "g"), timed_row(1, "h"));
  REQUIRE(apart);
  CHECK(apart->low < 1.43);
  CHECK(apart->high > 2.8);
  CHECK(apart->low > 2.0 / 3);  // no median lies beyond the times
  CHECK(apart->high < 6);
  const auto again = ratio_of_times(timed_row(2, "g"), timed_row(1, "h"));
  CHECK(again->low == apart->low);  // the seed is fixed
}

// ln of the ratio of two errors, each normal with a standard deviation of 1 %: the 95 % interval is 1 -+ 1.96 sqrt(2)
// %. With 1000 draws its ends are known to a standard error of .0006 (sqrt(p (1 - p) / n) over the density there, times
// .014): .003 is five of them.
TEST_CASE("a ratio of errors has the interval that theirs leave it", "[driver]") {
  Row a = timed_row(1, "g"), b = timed_row(1, "g");
  for (Row* row : {&a, &b}) row->measures = {{"rel_l2", 0.1, 0.1 - 0.00196, 0.1 + 0.00196, 0.001, false}};
  const auto ratio = bootstrap({&a}, {&b}, "rel_l2", [](const auto& x, const auto& y) {
    return std::optional(x[0].error.value / y[0].error.value);
  });
  REQUIRE(ratio);
  CHECK(ratio->low == Approx(1 - 0.0277).margin(0.003));
  CHECK(ratio->high == Approx(1 + 0.0277).margin(0.003));
}

namespace {

// A thousand bootstrap samples of a row's point.
std::vector<Point> drawn(const Row& row) {
  std::vector<Point> points;
  const Row one = timed_row(1, "another group");
  bootstrap({&row}, {&one}, "rel_l2", [&](const auto& x, const auto&) {
    points.push_back(x[0]);
    return std::optional(1.0);
  });
  REQUIRE(points.size() == 1001);
  CHECK(points[0].error.value == row.measures[0].value);  // as measured
  points.erase(points.begin());
  return points;
}

template <typename Predicate>
double share(const std::vector<Point>& points, const Predicate& holds) {
  return double(std::count_if(points.begin(), points.end(), holds)) / double(points.size());
}

}  // namespace

// The interval reaches .2 down and .6 up: standard deviations .102 and .306. So 2.5 % lie below 1.8, 25.7 % above 2.2
// (.653 of the wider one) and 2.5 % above 2.6, to five standard errors.
TEST_CASE("an error is drawn as lopsided as its interval is, and above 0", "[driver]") {
  Row row = timed_row(1, "g");
  row.measures = {{"rel_l2", 2, 1.8, 2.6, 0.1, false}};
  const auto points = drawn(row);
  CHECK(share(points, [](const Point& p) { return p.error.value < 1.8; }) == Approx(0.025).margin(0.025));
  CHECK(share(points, [](const Point& p) { return p.error.value < 2; }) == Approx(0.5).margin(0.08));
  CHECK(share(points, [](const Point& p) { return p.error.value > 2.2; }) == Approx(0.257).margin(0.07));
  CHECK(share(points, [](const Point& p) { return p.error.value > 2.6; }) == Approx(0.025).margin(0.025));
  // A standard deviation of 10.2 downwards: what falls below a thousandth of the value, 42.2 %, is put there.
  row.measures = {{"rel_l2", 2, -18, 4, 10, false}};
  const auto wide = drawn(row);
  CHECK(share(wide, [](const Point& p) { return p.error.value == Approx(0.002); }) == Approx(0.422).margin(0.08));
  CHECK(share(wide, [](const Point& p) { return p.error.value < 0.00199; }) == 0);
  row.measures = {{"rel_l2", 2, 2, 2, 0, false}};  // without noise
  CHECK(share(drawn(row), [](const Point& p) { return p.error.value == 2; }) == 1);
}

// The median of five draws from five times is one of them. It is the first if three or more draws are:
// 10 * .2^3 * .8^2 + 5 * .2^4 * .8 + .2^5 = 5.8 %; the middle one by symmetry most often.
TEST_CASE("a time is the median of as many draws as there were runs", "[driver]") {
  Row row = timed_row(1, "g");
  row.times = {1, 2, 4, 8, 16};
  const auto points = drawn(row);
  const auto is = [&](double time) { return share(points, [&](const Point& p) { return p.time.value == time; }); };
  CHECK(is(1) + is(2) + is(4) + is(8) + is(16) == Approx(1));
  CHECK(is(1) == Approx(0.058).margin(0.037));
  CHECK(is(16) == Approx(0.058).margin(0.037));
  CHECK(is(4) > 0.3);
}

TEST_CASE("without runs to draw from, or a figure in the draws, there is no interval", "[driver]") {
  Row few = timed_row(1, "g");
  few.times.resize(4);
  CHECK_FALSE(ratio_of_times(few, timed_row(1, "g")));
  int calls = 0;
  const Row row = timed_row(1, "g");
  CHECK_FALSE(bootstrap({&row}, {&row}, "rel_l2",
                        [&](const auto&, const auto&) { return ++calls % 2 ? std::optional(1.0) : std::nullopt; }));
}

TEST_CASE("a loaded machine is named in the conditions", "[driver]") {
  Outcome outcome;
  for (const double waited : {0.02, 0.3, much_waiting, 0.12}) {
    outcome.rows.push_back(timed_row(1, "g"));
    outcome.rows.back().scene = "s";
    outcome.rows.back().method = waited == 0.3 ? "worst" : "other";
    outcome.rows.back().waited = waited;
  }
  Row untimed;
  untimed.waited = 1;
  outcome.rows.push_back(untimed);
  CHECK_THAT(load_warning(outcome), Catch::Contains("in 2 of 4 timed rows") && Catch::Contains("more than 10 %") &&
                                        Catch::Contains("(s, worst: 30 %)"));
  outcome.rows.resize(1);
  CHECK(load_warning(outcome).empty());
}

}  // namespace driver_bootstrap_test
