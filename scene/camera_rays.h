// camera_ray for many pixels of one view, with what they share computed once: the same bits.
#pragma once
#include <Eigen/Geometry>
#include <cmath>

#include "scene/camera.h"

namespace airlight::scene {

class CameraRays {
 public:
  // The camera outlives this.
  CameraRays(const Camera& camera, int width, int height)
      : camera_(camera),
        width_(width),
        height_(height),
        aspect_(double(width) / height),
        half_(camera.kind == Camera::Kind::orthographic ? 0.5 * camera.height : std::tan(0.5 * camera.vertical_fov)) {}

  Ray operator()(double x, double y) const {
    const double sx = (2 * x / width_ - 1) * aspect_;  // [-aspect, aspect], to the right
    const double sy = 1 - 2 * y / height_;             // [-1, 1], upwards
    const Vec3 across = half_ * (sx * camera_.right + sy * camera_.up);
    if (camera_.kind == Camera::Kind::orthographic) return {camera_.position + across, camera_.forward};
    return {camera_.position, (camera_.forward + across).normalized()};
  }

 private:
  const Camera& camera_;
  int width_, height_;
  double aspect_, half_;
};

// The inverse of camera_ray: where a point is on the film (x, y) [pixels], and its depth along `forward` [m]. Behind a perspective camera
// (depth <= 0) x and y mean nothing.
inline Vec3 film_position(const Camera& camera, const Point3& x, int width, int height) {
  const Vec3 from = x - camera.position;
  const double depth = from.dot(camera.forward);
  const double half =
      camera.kind == Camera::Kind::orthographic ? 0.5 * camera.height : depth * std::tan(0.5 * camera.vertical_fov);
  const double aspect = double(width) / height;
  const double right = from.dot(camera.right) / (half * aspect), up = from.dot(camera.up) / half;
  return {0.5 * (1 + right) * width, 0.5 * (1 - up) * height, depth};
}

}  // namespace airlight::scene
