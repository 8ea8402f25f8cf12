// Errors against references that are noisy, tests that tell noise from bias, and medians of timings.
//
// d = a - r, the value under test minus the mean of the reference; s2 = estimated variance of that mean. The plain mean
// of d^2 is too large by the mean of s2: never report it against a noisy reference.
#pragma once
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace airlight::experiments {

// A value with its 95 % interval.
struct Estimate {
  double value;
  double low;
  double high;
};

// Mean squared error of `a` against a reference whose variance is known per value.
struct SquaredError {
  double raw;       // mean d^2
  double unbiased;  // mean (d^2 - s2); may be negative
  double variance;  // of `unbiased`: sum(4 d^2 s2 - 2 s2^2 + 2 s2^2/(n-1)) / N^2, at least 0
  double low;       // unbiased -+ 1.95996 sqrt(variance), not clipped
  double high;
  double floor;  // sqrt(mean s2)
};
// n: samples behind each s2 (>= 2). Equal lengths, not empty.
SquaredError squared_error(std::span<const double> a, std::span<const double> r, std::span<const double> s2,
                           std::span<const double> n);

// Mean of d^2 over mean of r^2 less its noise; and mean((d^2 - s2)/(r^2 + epsilon mean(r)^2)) with the same r in both
// places (biased by their correlation: the named metric rel_mse uses two halves).
double relative_squared_error(std::span<const double> a, std::span<const double> r, std::span<const double> s2);
double denominator_squared_error(std::span<const double> a, std::span<const double> r, std::span<const double> s2,
                                 double epsilon);

// 10 log10(peak^2 / mse) [dB].
double peak_signal_to_noise(double mse, double peak);

// Delete-one jackknife: `whole` from all groups, `without[b]` from all but group b. The interval uses Student's t with
// one degree less than there are groups; a further `variance` that is known better widens it (Welch's degrees).
Estimate jackknife(double whole, std::span<const double> without, double variance = 0);

// The value without its bias of first order in 1 / groups: n whole - (n - 1) mean of `without` (Quenouille).
double jackknife_value(double whole, std::span<const double> without);

// Two-sided threshold on the largest |z| of m independent standard normal values at false-alarm rate alpha:
// Phi^-1(1 - (1 - (1-alpha)^(1/m))/2); and Bonferroni's, which is a little larger.
double sidak_threshold(std::size_t m, double alpha);
double bonferroni_threshold(std::size_t m, double alpha);

// Probability that the largest of m independent |z| reaches `z`.
double sidak_probability(std::size_t m, double z);

// Probabilities that a chi-square value with m degrees of freedom is at least, at most x.
double chi_square_above(double x, double m);
double chi_square_below(double x, double m);

// The standard normal value with the same two-sided probability as Student's t with `degrees` of freedom.
double normal_from_student(double t, double degrees);

// How many standard deviations a mean must lie from 0 for Student's t of it to exceed `threshold` with probability
// `power`: the noncentrality of t. Infinite degrees: the sum of threshold and normal quantile.
double detectable_shift(double threshold, double degrees, double power);

// Quantiles: of the standard normal, and of Student's t.
double normal_quantile(double p);
double student_quantile(double p, double degrees);

double median(std::vector<double> x);
// Median of |x - median|, times 1.4826 an estimate of a normal standard deviation.
double median_absolute_deviation(const std::vector<double>& x);
inline constexpr double sigma_per_mad = 1.482602218505602;

// Ranks (1-based) of a distribution-free interval of the median of n values with at least 95 % coverage. Fewer than six
// values cannot reach 95 %: then the ranks are 1 and n. The coverage is 1 - 2 P(Binomial(n, 1/2) < lower).
struct RankInterval {
  int lower;
  int upper;
  double coverage;
};
RankInterval median_ranks(int n);

// Median with that interval.
Estimate median_estimate(std::vector<double> x);

}  // namespace airlight::experiments
