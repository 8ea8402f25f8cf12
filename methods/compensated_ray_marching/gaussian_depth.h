// Optical depth of a Gaussian of width and amplitude 1, seen from a distance: along a ray, and over all directions as zonal harmonics.
// Zhou et al. 2008, section 5.3 (their T(theta)).
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::compensated_ray_marching {

// Along the ray from a point `distance` away (in widths), at an angle to the centre whose cosine is mu; the Gaussian is cut at `cut`
// widths, infinity: not at all. In closed form.
double gaussian_depth(double distance, double mu, double cut = 3);

// T_l, l < order: sqrt((2l+1)/4pi) times the integral of depth P_l over the sphere. By quadrature, error 1e-10.
std::vector<double> zonal_depth(int order, double distance, double cut = 3);

// The angle that the publication tabulates by: pi at the centre, pi/2 a width away, 0 infinitely far. And back.
double angle_of_distance(double distance);
double distance_of_angle(double theta);

// T_l by linear interpolation. `paper`: over 256 equal angles, distances in widths, nothing infinitely far away. `even`: T_l (1 + d^2) over
// 256 equal steps of d / (1 + d), whose error stays relative far away, where many Gaussians add with one sign.
constexpr int depth_samples = 256;
class DepthTable {
 public:
  enum class Spacing { paper, even };
  DepthTable(int order, Spacing, int samples = depth_samples, double cut = 3);
  // Writes `order` numbers.
  void zonal(double distance, double* depth) const;
  int order() const { return order_; }
  const std::vector<double>& samples() const { return samples_; }  // [sample][l]

 private:
  int order_;
  Spacing spacing_;
  std::vector<double> samples_;  // [sample][l]
};

}  // namespace airlight::compensated_ray_marching
