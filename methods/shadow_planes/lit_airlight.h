// Airlight of one light along one ray whose lit parts are known.
#pragma once
#include <vector>

#include "methods/shadow_planes/bounded_media.h"
#include "methods/shadow_planes/options.h"
#include "scene/light/light.h"

namespace airlight::shadow_planes {

class LitAirlight {
 public:
  // Requires homogeneous media. One without a region is evaluated in its own form, others by BoundedMedia.
  LitAirlight(const std::vector<scene::Medium>&, const Options&);

  // L [W/m^2/sr] of a point or spot light over [begin, end] of the ray; end may be infinite.
  Rgb operator()(const scene::Light&, const Ray&, Interval lit) const;
  // Where on the ray the media are, from the first to the last; empty if nowhere.
  Interval extent(const Ray& ray, Interval t) const { return alone_ ? t : bounded_.extent(ray, t); }

 private:
  Rgb part(const scene::Light&, const Point3& light, const Ray&, Interval) const;
  double polynomial(double extinction, const LightFromRay&, Interval) const;

  Options options_;
  PhaseForm phase_;
  Rgb extinction_ = Rgb::Zero(), albedo_ = Rgb::Zero();
  bool alone_;  // one medium that fills all space
  BoundedMedia bounded_;
  MappedRule<double> rule_, bounded_rule_;
};

// Places on the ray where a cone around `axis` at the light is crossed, appended [m]; angle in (0, pi).
void cross_cone(const LightFromRay&, const Vec3& direction, const Vec3& axis, double angle,
                std::vector<double>& places);

}  // namespace airlight::shadow_planes
