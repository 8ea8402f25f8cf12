// Airlight in several homogeneous media, each in a convex region: Biri et al. 2006, sections 4.2 and 5.2.
//
// Exact: every medium dims the way from the light and the way to the eye by the lengths of both inside it, so that
// media tint one another. The paper drops those terms and replaces the light's way by a constant: paper_medium.h.
#pragma once
#include <algorithm>
#include <vector>

#include "methods/shadow_planes/light_from_ray.h"
#include "methods/shadow_planes/mapped_rule.h"
#include "scene/media/medium.h"

namespace airlight::shadow_planes {

class BoundedMedia {
 public:
  // Requires homogeneous media, overlapping or not; an unbounded one is a region like others.
  explicit BoundedMedia(const std::vector<scene::Medium>&, bool printed_phases = false);

  // L [W/m^2/sr] on a lit part of the ray, per W/sr of the light towards each point (times its intensity). `intensity(d)`:
  // relative, towards the unit direction d from the light. The rule's error on every stretch between the places where a
  // way enters or leaves a region or passes one of its edges.
  template <class Intensity>
  Rgb airlight(const MappedRule<double>&, const Ray&, const Point3& light, Interval lit, Intensity&& intensity) const;

  // From where the ray enters the first medium to where it leaves the last; empty if it meets none.
  Interval extent(const Ray&, Interval t) const;

  // Places along the ray between which all is smooth, `lit`'s ends included, ascending.
  std::vector<double> stretches(const Ray&, const Point3& light, Interval lit) const;

 private:
  struct Medium {
    Rgb extinction, albedo;
    PhaseForm phase;
    scene::Region region;
  };
  Rgb depth(const Ray&, double length) const;

  std::vector<Medium> media_;
};

template <class Intensity>
Rgb BoundedMedia::airlight(const MappedRule<double>& rule, const Ray& ray, const Point3& light, Interval lit,
                           Intensity&& intensity) const {
  const LightFromRay from = light_from_ray(ray, light);
  const std::vector<double> places = stretches(ray, light, lit);
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    const LitPart<double> part{places[k], places[k + 1] - places[k]};
    const Point3 middle = ray.at(std::isfinite(part.length) ? part.x0 + 0.5 * part.length : part.x0 + 1);
    std::vector<const Medium*> here;
    Rgb extinction = Rgb::Zero();
    double width = 1;
    for (const Medium& medium : media_)
      if (contains(medium.region, middle)) {
        here.push_back(&medium);
        extinction += medium.extinction;
        width = std::min(width, medium.phase.width());
      }
    if (here.empty()) continue;
    for (int channel = 0; channel < 3; ++channel) {
      if (!(extinction[channel] > 0)) continue;
      const double h = std::max(from.h, 1e-120 * std::abs(part.x0 - from.T));
      // x - x0 is half of h (q - q0) at least; the light's way, which grows with it elsewhere, may get less here: by as
      // much as dims it where the part begins.
      const Vec3 first = ray.at(part.x0) - light;
      const double cut = MappedRule<double>::depth_cut, r0 = first.norm();
      const double dimmed = r0 > 0 ? depth({light, first / r0}, r0)[channel] : 0;
      const double slowest = 0.5 * extinction[channel] * cut / (cut + dimmed);
      sum[channel] += mapped_integral(
          rule, width, extinction[channel], slowest, from.T, from.h, part, [&](double q, double v, double w, double) {
            const Vec3 d = 2 * q * v * from.n + (w - v) * ray.direction;
            const double x = from.T + 0.5 * h * (q - 1 / q), r = 0.5 * h * (q + 1 / q);
            const double lost = depth({light, d}, r)[channel] + depth(ray, x)[channel];
            double scattered = 0;
            for (const Medium* medium : here)
              scattered += medium->albedo[channel] * medium->extinction[channel] * phase_of_halves(medium->phase, v, w);
            return scattered * std::exp(-lost) * intensity(d);
          });
    }
  }
  return sum / (4 * pi);
}

}  // namespace airlight::shadow_planes
