// Columns of a sum of Gaussians along many parallel rays.
#pragma once
#include <vector>

#include "scene/media/gaussian_sum.h"

namespace airlight::compensated_ray_marching {

class GaussianColumns {
 public:
  // Sums with negative amplitudes are clamped along the way, and a constant has no end: density_integral.
  static bool knows(const scene::GaussianSum&);
  explicit GaussianColumns(const scene::GaussianSum&);

  // Integrals of the density from each point along a direction (unit) without end [m], Zhou et al. 2007, Eq. 31; the closer the points, the
  // fewer Gaussians are looked at. Single precision: error 3e-7 of amplitude times width of every Gaussian near the rays.
  void from(const std::vector<Point3>& points, const Vec3& direction, float* columns) const;

 private:
  float cutoff_;                                          // [widths]
  std::vector<double> x_, y_, z_, width_, reach_, full_;  // full: the integral along a line through the centre
};

}  // namespace airlight::compensated_ray_marching
