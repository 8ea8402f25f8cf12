#include "experiments/judging/statistics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "experiments/judging/front.h"

namespace statistics_test {

using namespace airlight::experiments;

namespace {

Point point(double time, double error) { return {{time, time, time}, {error, error, error}}; }

}  // namespace

TEST_CASE("tails add up, and ranks of a median cover it", "[statistics]") {
  for (const double x : {1e-3, 7.0, 30.0})
    CHECK(chi_square_above(x, 8) + chi_square_below(x, 8) == Approx(1).epsilon(1e-14));
  for (const int n : {6, 10, 25, 100}) CHECK(median_ranks(n).coverage >= 0.95);
  // Five values: the whole range covers the median unless all five lie on one side, 2/32.
  const RankInterval five = median_ranks(5);
  CHECK(five.lower == 1);
  CHECK(five.upper == 5);
  CHECK(five.coverage == Approx(1 - 2.0 / 32));
}

// Probability tails of Student's t by quantile and back; t of one degree is Cauchy: quantile(0.75) = 1.
TEST_CASE("Student's t as a normal value", "[statistics]") {
  CHECK(student_quantile(0.75, 1) == Approx(1).epsilon(1e-12));
  CHECK(normal_from_student(1, 1) == Approx(normal_quantile(0.75)).epsilon(1e-12));
  CHECK(normal_from_student(-student_quantile(0.975, 15), 15) == Approx(-normal_quantile(0.975)).epsilon(1e-10));
  CHECK(normal_from_student(1e300, 15) == 38);
}

TEST_CASE("a point whose intervals overlap another's does not dominate it", "[statistics]") {
  const Point sure{{1, 0.9, 1.1}, {0.1, 0.09, 0.11}};
  const Point overlapping{{1.2, 1.05, 1.3}, {0.2, 0.15, 0.3}};
  const Point beaten{{1.2, 1.15, 1.3}, {0.2, 0.15, 0.3}};
  CHECK_FALSE(dominates(sure, overlapping));
  CHECK(dominates(sure, beaten));
  CHECK_FALSE(dominates(sure, sure));
  // Equal ends: no worse; better in one is enough, in none is not.
  CHECK(dominates(point(1, 1), point(1, 2)));
  CHECK(dominates(point(1, 1), point(2, 1)));
  CHECK_FALSE(dominates(point(1, 1), point(1, 1)));
  CHECK_FALSE(dominates(point(1, 2), point(2, 1)));
}

// In order of time; equal times by error. Area of two steps under (e^4, e^4): from time e to e^3 a height of 4 - 2,
// then to e^4 of 4 - 0; what lies beyond the corner counts nothing.
TEST_CASE("fronts and areas by hand", "[statistics]") {
  const std::vector<Point> points{point(std::exp(3), 1), point(std::exp(1), std::exp(2)), point(std::exp(3), 2),
                                  point(std::exp(5), 1e-3), point(std::exp(0.5), std::exp(5))};
  CHECK(front(points) == std::vector<std::size_t>{4, 1, 0, 3});
  CHECK(hypervolume(points, std::exp(4), std::exp(4)) == Approx(2 * 2 + 1 * 4).epsilon(1e-12));
}

// Errors that fall as 1/t and 4/t: at equal error the first is four times as fast, at equal time four times as good.
TEST_CASE("equal time and equal error between two curves", "[statistics]") {
  std::vector<Point> good, bad;
  for (const double t : {1.0, 3.0, 10.0, 30.0, 100.0}) {
    good.push_back(point(t, 1 / t));
    bad.push_back(point(t, 4 / t));
  }
  CHECK(*error_at_time(good, 5) == Approx(0.2).epsilon(1e-12));
  CHECK(*time_at_error(bad, 0.4) == Approx(10).epsilon(1e-12));
  CHECK_FALSE(error_at_time(good, 0.5));
  CHECK_FALSE(time_at_error(good, 0.001));
  const auto ratio = speed_up(bad, good);
  REQUIRE(ratio);
  CHECK(ratio->geometric_mean == Approx(4).epsilon(1e-12));
  CHECK(ratio->least == Approx(4).epsilon(1e-12));
  CHECK(ratio->to == Approx(1));
  CHECK(ratio->from == Approx(0.04));
  const auto better = error_ratio(bad, good);
  REQUIRE(better);
  CHECK(better->geometric_mean == Approx(4).epsilon(1e-12));
  CHECK(better->from == Approx(1));
  CHECK(better->to == Approx(100));
  // A baseline with one setting, at time 5: error 0.8 there, 0.2 on the good curve.
  CHECK(error_ratio({point(5, 0.8)}, good)->geometric_mean == Approx(4).epsilon(1e-12));
  CHECK_FALSE(error_ratio({point(0.5, 0.8)}, good));
}

// Times 1/e and e^-1/2 for the error e from 1 to 0.01: their ratio e^-1/2 goes from 1 to 10, evenly in logarithms, so
// the geometric mean is sqrt(10) (the arithmetic one over ln e would be 9 / ln 10 = 3.9).
TEST_CASE("gains are geometric means over what both reach", "[statistics]") {
  const std::vector<Point> slow{point(1, 1), point(100, 0.01)}, fast{point(1, 1), point(10, 0.01)};
  const auto gain = speed_up(slow, fast);
  REQUIRE(gain);
  CHECK(gain->geometric_mean == Approx(std::sqrt(10)).epsilon(1e-12));
  CHECK(gain->least == Approx(1).epsilon(1e-12));
  CHECK(gain->greatest == Approx(10).epsilon(1e-12));
  CHECK(gain->from == Approx(0.01));
  CHECK(gain->to == Approx(1));
  // Errors 1/t and 1/t^2 over the times 1 to 10: ratio t.
  const auto better = error_ratio(slow, fast);
  REQUIRE(better);
  CHECK(better->geometric_mean == Approx(std::sqrt(10)).epsilon(1e-12));
  CHECK(better->greatest == Approx(10).epsilon(1e-12));
  CHECK(better->to == Approx(10));
  // Points that a faster one beats are not on the curve; curves that touch in one error have the ratio there.
  const auto touching = speed_up({point(2, 1), point(3, 5), point(8, 0.25)}, {point(1, 0.25), point(4, 0.1)});
  REQUIRE(touching);
  CHECK(touching->geometric_mean == Approx(8).epsilon(1e-12));
  CHECK(touching->from == Approx(0.25));
  CHECK_FALSE(speed_up({point(2, 1)}, {}));
}

TEST_CASE("two curves without a common error say which one is closer", "[statistics]") {
  const std::vector<Point> far{point(2, 0.5), point(4, 0.1)}, close{point(1, 0.05), point(3, 0.01), point(5, 0)};
  CHECK_FALSE(speed_up(far, close));
  const auto apart = apart_in_error(far, close);
  REQUIRE(apart);
  CHECK(apart->other_is_closer);
  CHECK(apart->error == 0.05);
  CHECK(apart->least_error == 0.1);
  CHECK(apart->fastest_to_closest == Approx(0.25));
  CHECK(apart->slowest_to_fastest == Approx(2.5));
  REQUIRE(apart_in_error(close, far));
  CHECK_FALSE(apart_in_error(close, far)->other_is_closer);
  CHECK_FALSE(apart_in_error(far, far));
  CHECK_FALSE(apart_in_error({}, far));
  CHECK_FALSE(apart_in_error({point(1, 0.5)}, {point(2, 0.5)}));  // they meet in one error
  CHECK_FALSE(speed_up_of_exact(far, close));
  CHECK_FALSE(speed_up_of_exact({}, {point(1, 0)}));
  CHECK(*speed_up_of_exact({point(8, 0.1), point(20, 0), point(10, 0)}, close) == Approx(2));
}

// For a mean the jackknife's variance is s^2 / n. Here 1, 2, 3, 6: mean 3, s^2 = 14/3, s^2 / 4 = 7/6;
// t(0.975, 3) = 3.182446 (tables).
TEST_CASE("a jackknife by hand", "[statistics]") {
  const std::vector<double> without{11.0 / 3, 10.0 / 3, 3, 2};
  const Estimate e = jackknife(3, without);
  CHECK(e.value == 3);
  CHECK(e.high - 3 == Approx(3.182446305 * std::sqrt(7.0 / 6)).epsilon(1e-8));
  CHECK(3 - e.low == Approx(e.high - 3).epsilon(1e-12));
  // A second variance that is known exactly, 7/6 too: twice as much, with 3 * 2^2 = 12 degrees (2.178813).
  CHECK(jackknife(3, without, 7.0 / 6).high - 3 == Approx(2.178812830 * std::sqrt(7.0 / 3)).epsilon(1e-8));
  // Alone, it is normal.
  CHECK(jackknife(3, std::vector<double>{3, 3, 3}, 4).high - 3 == Approx(2 * 1.959963985).epsilon(1e-8));
  CHECK_THROWS(jackknife(3, std::vector<double>{3}));
  // The square of a mean has the bias s^2 / n: the corrected value of 3^2 is 9 - 7/6.
  std::vector<double> squares;
  for (const double x : without) squares.push_back(x * x);
  CHECK(jackknife_value(9, squares) == Approx(9 - 7.0 / 6).epsilon(1e-12));
}

// By the definition: 200,000 draws of t. The standard deviation of the rate at 0.95 is 4.9e-4; 2.3e-3 is 4.7 of them.
TEST_CASE("a detectable shift is found as often as it says", "[statistics]") {
  CHECK(detectable_shift(2, std::numeric_limits<double>::infinity(), 0.95) == Approx(2 + 1.644853627).epsilon(1e-9));
  const double threshold = student_quantile(1 - 1e-4 / 6, 15), shift = detectable_shift(threshold, 15, 0.95);
  CHECK(shift > threshold + student_quantile(0.95, 15));  // the standard error is noisy, too
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::chi_squared_distribution<double> chi_squared(15);
  int found = 0;
  for (int i = 0; i < 200000; ++i) found += (normal(random) + shift) / std::sqrt(chi_squared(random) / 15) > threshold;
  CHECK(std::abs(found / 200000.0 - 0.95) < 2.3e-3);
}

// 95 % intervals cover the true mean in about 95 % of 2000 repeats. The count outside is binomial: with rate 0.05 its
// standard deviation is 9.7; 100 +- 45 is 4.6 of them (false alarm 4e-6). Gaussian groups: the interval is exact.
TEST_CASE("jackknife intervals of a mean cover it", "[statistics]") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(3, 2);
  int outside = 0;
  for (int repeat = 0; repeat < 2000; ++repeat) {
    std::vector<double> x(16), without;
    double sum = 0;
    for (double& v : x) sum += v = normal(random);
    for (const double v : x) without.push_back((sum - v) / 15);
    const Estimate e = jackknife(sum / 16, without);
    outside += e.low > 3 || e.high < 3;
  }
  CHECK(std::abs(outside - 100) <= 45);
}

}  // namespace statistics_test
