#include "experiments/judging/statistics.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>

#include "scene/base/error.h"

namespace airlight::experiments {
namespace bm = boost::math;
namespace {

void require_equal(std::size_t a, std::size_t b) {
  if (a != b || a == 0) throw Error("statistics: lists of different length, or empty");
}

// log((1-alpha)^(1/m)) without losing alpha/m to rounding.
double tail_per_test(std::size_t m, double alpha) { return -std::expm1(std::log1p(-alpha) / double(m)); }

}  // namespace

SquaredError squared_error(std::span<const double> a, std::span<const double> r, std::span<const double> s2,
                           std::span<const double> n) {
  require_equal(a.size(), r.size());
  require_equal(a.size(), s2.size());
  require_equal(a.size(), n.size());
  double raw = 0, noise = 0, variance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d2 = (a[i] - r[i]) * (a[i] - r[i]);
    raw += d2;
    noise += s2[i];
    variance += 4 * d2 * s2[i] - 2 * s2[i] * s2[i] + 2 * s2[i] * s2[i] / (n[i] - 1);
  }
  const double count = double(a.size());
  SquaredError e;
  e.raw = raw / count;
  e.unbiased = (raw - noise) / count;
  e.variance = std::max(0.0, variance) / (count * count);
  const double half = normal_quantile(0.975) * std::sqrt(e.variance);
  e.low = e.unbiased - half;
  e.high = e.unbiased + half;
  e.floor = std::sqrt(noise / count);
  return e;
}

double relative_squared_error(std::span<const double> a, std::span<const double> r, std::span<const double> s2) {
  require_equal(a.size(), r.size());
  require_equal(a.size(), s2.size());
  double error = 0, signal = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error += (a[i] - r[i]) * (a[i] - r[i]) - s2[i];
    signal += r[i] * r[i] - s2[i];
  }
  return error / signal;
}

double denominator_squared_error(std::span<const double> a, std::span<const double> r, std::span<const double> s2,
                                 double epsilon) {
  require_equal(a.size(), r.size());
  require_equal(a.size(), s2.size());
  double mean = 0;
  for (const double x : r) mean += x;
  mean /= double(r.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += ((a[i] - r[i]) * (a[i] - r[i]) - s2[i]) / (r[i] * r[i] + epsilon * mean * mean);
  return sum / double(a.size());
}

double peak_signal_to_noise(double mse, double peak) { return 10 * std::log10(peak * peak / mse); }

namespace {

double mean_of(std::span<const double> x) {
  double mean = 0;
  for (const double v : x) mean += v / double(x.size());
  return mean;
}

}  // namespace

Estimate jackknife(double whole, std::span<const double> without, double variance) {
  const double groups = double(without.size());
  if (without.size() < 2) throw Error("jackknife: fewer than two groups");
  const double mean = mean_of(without);
  double sum = 0;
  for (const double x : without) sum += (x - mean) * (x - mean);
  const double own = (groups - 1) / groups * sum, all = own + variance;
  const double degrees = own > 0 ? (groups - 1) * (all / own) * (all / own) : std::numeric_limits<double>::infinity();
  const double half = student_quantile(0.975, degrees) * std::sqrt(all);
  return {whole, whole - half, whole + half};
}

double jackknife_value(double whole, std::span<const double> without) {
  const double groups = double(without.size());
  return groups * whole - (groups - 1) * mean_of(without);
}

double sidak_threshold(std::size_t m, double alpha) {
  return bm::quantile(bm::complement(bm::normal(), tail_per_test(m, alpha) / 2));
}

double bonferroni_threshold(std::size_t m, double alpha) {
  return bm::quantile(bm::complement(bm::normal(), alpha / double(m) / 2));
}

double sidak_probability(std::size_t m, double z) {
  const double tail = 2 * bm::cdf(bm::complement(bm::normal(), std::abs(z)));
  return -std::expm1(double(m) * std::log1p(-tail));
}

double chi_square_above(double x, double m) { return bm::cdf(bm::complement(bm::chi_squared(m), x)); }
double chi_square_below(double x, double m) { return bm::cdf(bm::chi_squared(m), x); }

double normal_from_student(double t, double degrees) {
  if (std::isinf(t)) return t;
  const double tail = bm::cdf(bm::complement(bm::students_t(degrees), std::abs(t)));
  // Below the smallest double the normal value would be infinite; 38 is already beyond any threshold.
  const double z = tail > 0 ? bm::quantile(bm::complement(bm::normal(), tail)) : 38.0;
  return std::copysign(z, t);
}

double detectable_shift(double threshold, double degrees, double power) {
  if (std::isinf(degrees)) return threshold + normal_quantile(power);
  const auto excess = [&](double shift) {
    return bm::cdf(bm::complement(bm::non_central_t(degrees, shift), threshold)) - power;
  };
  double top = 1;
  while (excess(top) < 0) top *= 2;
  const auto [low, high] = bm::tools::bisect(excess, 0.0, top, bm::tools::eps_tolerance<double>(40));
  return 0.5 * (low + high);
}

double normal_quantile(double p) { return bm::quantile(bm::normal(), p); }
double student_quantile(double p, double degrees) { return bm::quantile(bm::students_t(degrees), p); }

double median(std::vector<double> x) {
  if (x.empty()) throw Error("median of nothing");
  std::sort(x.begin(), x.end());
  const std::size_t n = x.size();
  return n % 2 ? x[n / 2] : 0.5 * (x[n / 2 - 1] + x[n / 2]);
}

double median_absolute_deviation(const std::vector<double>& x) {
  const double center = median(x);
  std::vector<double> distance;
  for (const double v : x) distance.push_back(std::abs(v - center));
  return median(distance);
}

RankInterval median_ranks(int n) {
  if (n < 1) throw Error("ranks of the median of nothing");
  const bm::binomial half(n, 0.5);
  int lower = 1;
  while (2 * (lower + 1) <= n && bm::cdf(half, lower) <= 0.025) ++lower;
  return {lower, n + 1 - lower, 1 - 2 * bm::cdf(half, lower - 1)};
}

Estimate median_estimate(std::vector<double> x) {
  const double center = median(x);
  const RankInterval ranks = median_ranks(int(x.size()));
  std::sort(x.begin(), x.end());
  return {center, x[std::size_t(ranks.lower - 1)], x[std::size_t(ranks.upper - 1)]};
}

}  // namespace airlight::experiments
