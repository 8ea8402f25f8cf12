// Encodings of the optical depth along the ray of a texel. Depths along the ray are shares of the map's range, in [0,
// 1]. Steps divide the range equally; step i has the optical depth tau_i and its middle at d_i = (i + 1/2) / steps.
//
//   slices   N + 1 optical depths at k/N; linear between them.
//   avsm     n nodes (d, T), straight lines of transmittance between them. Salvi, Vidimce, Lauritzen, Lefohn 2010:
//            nodes come front to back, and where there are more than n the inner node goes whose removal changes the
//            area under the lines least. The first node is where the first step that is not empty begins.
//            Stored: the d, then the T.
//   fourier  a_k = 2 sum tau_i cos 2 pi k d_i, b_k = 2 sum tau_i sin 2 pi k d_i (Jansen and Bavoil 2010), stored as a_0,
//            a_1, b_1, a_2, b_2, ...; optical depth(d) = a_0 d / 2
//            + sum_k (a_k sin 2 pi k d + b_k (1 - cos 2 pi k d)) / (2 pi k)
//   beer     front, mean, total: where the first step begins that is not empty, the optical depth per depth of those that
//            are not empty, as if they had all of it, and the optical depth of all;
//            optical depth(d) = min(total, mean (d - front)). Empty is what has at most `empty_share` of the deepest step:
//            the faint fringe of smoke has many steps, and with them the mean says nothing.
//
// Optical depths may be negative, of Gaussians that take away from a constant; then beer's minimum is of absolute values.
#pragma once
#include <span>
#include <vector>

#include "reference/light_map/options.h"

namespace airlight::light_map {

constexpr double empty_share = 0.01;
// Transmittance is read as this where it is less: its logarithm stays finite.
constexpr double least_transmittance = 1e-37;

class Encoder {
 public:
  explicit Encoder(const Options&);
  // The optical depths of all steps to floats_per_texel floats.
  void encode(std::span<const double> steps, float* texel) const;
  // Weights of each step's optical depth in the coefficients of `fourier`, step by step.
  const std::vector<double>& waves() const { return waves_; }

 private:
  void encode_slices(std::span<const double> steps, float* texel) const;
  void encode_fourier(std::span<const double> steps, float* texel) const;
  Options options_;
  std::vector<double> waves_;  // of `fourier`, [step][coefficient]: 2 cos 2 pi k d_i, 2 sin 2 pi k d_i
};

// Optical depth from 0 to d of a texel.
double decode(const Options&, const float* texel, double d);

}  // namespace airlight::light_map
