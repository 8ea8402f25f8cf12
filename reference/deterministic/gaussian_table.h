// A sum of Gaussians as arrays, for passes over all of them per ray.
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

}  // namespace airlight::deterministic
