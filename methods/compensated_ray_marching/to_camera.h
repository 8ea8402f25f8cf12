#pragma once
#include "scene/camera.h"

namespace airlight::compensated_ray_marching {

// The unit direction in which light travels from x to the eye; at the eye, against the camera's view.
inline Vec3 to_camera(const scene::Camera& camera, const Point3& x) {
  if (camera.kind == scene::Camera::Kind::orthographic) return -camera.forward;
  const Vec3 way = camera.position - x;
  const double length = way.norm();
  return length > 0 ? Vec3(way / length) : Vec3(-camera.forward);
}

}  // namespace airlight::compensated_ray_marching
