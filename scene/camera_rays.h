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

}  // namespace airlight::scene
