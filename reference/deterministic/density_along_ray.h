// The density of one medium along one view ray: value and integral, prepared once per ray because a quadrature asks for
// them hundreds of times.
#pragma once
#include <memory>
#include <vector>

#include "reference/deterministic/gaussian_table.h"
#include "scene/media/medium.h"

namespace airlight::deterministic {

// A place where the density or its derivative jumps (width 0), or around which it varies over a length `width`.
struct Feature {
  double t;
  double width;
};

class DensityAlongRay {
 public:
  virtual ~DensityAlongRay() = default;
  Interval extent() const { return extent_; }   // outside, the density is 0
  virtual double density(double t) const = 0;   // t inside the extent [-]
  virtual double integral(double t) const = 0;  // from t = 0 to t, any t >= 0 [m]
  virtual void add_features(std::vector<Feature>&) const = 0;
  virtual bool fine() const { return false; }  // so many features that a short rule between them is enough

 protected:
  explicit DensityAlongRay(Interval extent) : extent_(extent) {}
  Interval extent_;
};

// Null where the ray misses the medium. `table` is the medium's Gaussians, or null. Gaussians whose density on this
// ray is below `cull` times the greatest, and whose optical depth is below `cull`, are dropped.
std::unique_ptr<DensityAlongRay> density_along_ray(const scene::Medium&, const GaussianTable* table, const Ray&,
                                                   double t_end, double cull);

}  // namespace airlight::deterministic
