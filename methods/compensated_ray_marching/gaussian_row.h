// Gaussians along the view rays of one row of pixels, which lie in a plane. Only Gaussians that meet the plane are
// evaluated, and only where the ray is within them. Zhou et al. 2008, section 5.5, draw the Gaussians slice by slice;
// here they are added ray by ray.
#pragma once
#include <vector>

#include "scene/media/gaussian_sum.h"

namespace airlight::compensated_ray_marching {

// Equal slices of a ray; each is sampled in its middle.
struct RaySlices {
  double start = 0, step = 0;  // [m] along the ray
  int count = 0;
  double middle(int k) const { return start + (k + 0.5) * step; }
};

class GaussianRow {
 public:
  // values: one of each Gaussian, to be interpolated between their centres; null: none. The plane: a point, a unit normal.
  GaussianRow(const scene::GaussianSum&, const std::vector<Rgb>* values, const Point3&, const Vec3& normal);
  // Where there is density along a ray.
  Interval extent(const Ray& ray, Interval t) const { return scene::extent(near_, ray, t); }
  // Adds to the densities, count of them, and with values to those times density. Returns how many samples of Gaussians that took.
  long add(const Ray&, const RaySlices&, double* density, Rgb* weighted) const;

 private:
  scene::GaussianSum near_;
  std::vector<Rgb> values_;  // of each
  double cut2_;
};

}  // namespace airlight::compensated_ray_marching
