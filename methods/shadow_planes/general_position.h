// Rays from a camera that lies exactly in the plane of an edge and the light.
#pragma once
#include "scene/math/types.h"

namespace airlight::shadow_planes {

// Where a ray from `origin` begins as far as shadows are concerned: beside it by 2e-13 of its distance to the light, in
// a direction that is no scene's own. A camera in the plane of an edge and the light, as in scenes that are made by
// hand, would be on either side of it as rounding has it, ray by ray; counted and crossed from here it is on one.
// The step is 900 roundings of the distance: one of 9 (2e-15) was enough in the scenes that showed it.
inline Point3 origin_in_general_position(const Point3& origin, const Point3& light) {
  const double step = 2e-13 * (origin - light).norm() + 4e-15 * (origin.norm() + light.norm());
  return origin + step * Vec3(0.5377, 0.3171, 0.7812);
}
inline Ray ray_in_general_position(const Ray& ray, const Point3& light) {
  return {origin_in_general_position(ray.origin, light), ray.direction};
}

}  // namespace airlight::shadow_planes
