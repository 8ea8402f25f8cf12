// exp of a function of real spherical harmonics, as harmonics again: from optical depths to transmittances. Zhou et al. 2008, section 5.3,
// after Ren et al. 2006. All take order^2 coefficients and give as many.
#pragma once
#include <cmath>
#include <vector>

#include "scene/math/sh_product.h"

namespace airlight::compensated_ray_marching {

using Harmonics = std::vector<double>;

// The projection of exp of the function, by quadrature over the sphere (24 x 48 points): what the others approximate.
Harmonics exact_exponential(const Harmonics&);

// exp(f) ~ exp(f_0 / sqrt(4 pi)) (a + b f^) with f^ the function without its mean, and a, b by the size of f^: the optimal linear
// approximation (OL) over a family of functions -s h, |h| = 1. Between the tabulated s, their logarithms are linear.
class LinearExponential {
 public:
  // `family`: unit vectors h of order^2 coefficients, the first 0. Sizes s from 0 to `longest` in equal steps.
  LinearExponential(const std::vector<Harmonics>& family, double longest = 40, int steps = 800);
  Harmonics operator()(const Harmonics&) const;
  // a and b at a size.
  double constant(double size) const { return std::exp(at(log_a_, size)); }
  double slope(double size) const { return std::exp(at(log_b_, size)); }
  // The tables: logarithms at equal steps of the size, from 0 to the longest.
  const std::vector<double>& log_constants() const { return log_a_; }
  const std::vector<double>& log_slopes() const { return log_b_; }
  double longest() const { return longest_; }

 private:
  double at(const std::vector<double>&, double size) const;
  double longest_;
  std::vector<double> log_a_, log_b_;
};

// Families of depths: sums of the given numbers of Gaussians, as many of each, around random axes at log-uniform distances of 0.3 to 10
// widths. `members` of each number.
std::vector<Harmonics> depth_family(int order, const std::vector<int>& counts, int members);

// Scaling and squaring (HYB of Ren et al. 2006): f / 2^p is at most `threshold` long without its mean; its linear approximation is squared p times.
Harmonics squared_exponential(const Harmonics&, const LinearExponential&, double threshold = 0.5);

// Scaling and squaring of the product series of degree 3, without a table; as good as HYB with a threshold of 0.1.
constexpr double series_threshold = 1;
Harmonics series_exponential(const Harmonics&, double threshold = series_threshold);

}  // namespace airlight::compensated_ray_marching
