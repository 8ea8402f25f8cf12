// A point light as a ray sees it: Biri et al. 2006, Fig. 2.
#pragma once
#include "scene/math/types.h"

namespace airlight::shadow_planes {

struct LightFromRay {
  double T;  // [m] along the ray to the point closest to the light; negative behind
  double h;  // [m] from there to the light
  Vec3 n;    // unit, from the light to that point; any perpendicular of the ray where h = 0
};
inline LightFromRay light_from_ray(const Ray& ray, const Point3& light) {
  const Vec3 offset = light - ray.origin;
  const double T = offset.dot(ray.direction);
  const Vec3 foot = T * ray.direction - offset;  // from the light
  const double h = foot.norm();
  return {T, h, h > 0 ? Vec3(foot / h) : Vec3(ray.direction.unitOrthogonal())};
}

}  // namespace airlight::shadow_planes
