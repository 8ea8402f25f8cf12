// One medium in a convex region in the paper's way: Biri et al. 2006, section 4.2 and 5.2.
//
// Light reaches every point through the same length R of medium, the way to the eye begins where the ray enters, and
// other media dim neither.
#pragma once
#include "methods/shadow_planes/light_from_ray.h"
#include "methods/shadow_planes/mapped_rule.h"
#include "methods/shadow_planes/options.h"
#include "scene/light/light.h"
#include "scene/media/medium.h"

namespace airlight::shadow_planes {

// Mean distance [m] between a point of the region's boundary and one inside it, both uniform: 6/5 of a sphere's radius,
// a box's by quadrature, to 1e-6 of it. Requires a box or a sphere.
double mean_distance(const scene::Region&);

class PaperMedium {
 public:
  PaperMedium(const scene::Medium&, const Options&);  // requires a homogeneous one in a box or a sphere

  const scene::Region& region() const { return region_; }
  double R() const { return R_; }  // [m]

  // L [W/m^2/sr] of a point or spot light over the part of `lit` in the medium, by the evaluator of the options.
  Rgb operator()(const scene::Light&, const Ray&, Interval lit) const;
  Interval extent(const Ray& ray, Interval t) const { return clip(region_, ray, t); }

 private:
  template <class Intensity>
  double part(double extinction, const LightFromRay&, double x_in, Interval, Intensity&&) const;
  template <class LitPhase>
  double before_foot(double extinction, double h, double begin, double end, LitPhase&&) const;

  Options options_;
  scene::Region region_;
  Rgb extinction_, albedo_;
  PhaseForm phase_;
  double R_;
  MappedRule<double> rule_;
};

}  // namespace airlight::shadow_planes
