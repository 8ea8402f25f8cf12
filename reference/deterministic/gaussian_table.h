// A sum of Gaussians as arrays, for many evaluations of depths to a stated absolute error.
#pragma once
#include <optional>
#include <vector>

#include "scene/media/gaussian_sum.h"

namespace airlight::deterministic {

struct GaussianTable {
  std::vector<double> x, y, z;           // centres [m]
  std::vector<double> inverse_width;     // a_i [1/m]
  std::vector<double> amplitude;         // c_i [-], > 0
  std::vector<double> scaled_amplitude;  // c_i sqrt(pi) / (2 a_i) [m]: half the integral over a line through the centre
  std::vector<double> log_scaled;        // its logarithm
  double constant = 0;
  double cutoff = infinity;  // [widths]
  std::size_t size() const { return x.size(); }
};

// Nothing if an amplitude is negative: then the density is clamped at 0, and no sum of single integrals.
std::optional<GaussianTable> make_gaussian_table(const scene::GaussianSum&);

// Integral of the density over t in [t0, t1] of the ray [m]; t1 may be infinite. Every Gaussian whose whole line
// integral is below `skip` [m] counts as 0.
double density_integral(const GaussianTable&, const Ray&, Interval t, double skip);

// erf(v) - erf(u), 0 unless u < v; the tails keep their relative accuracy.
double erf_difference(double u, double v);

}  // namespace airlight::deterministic
