#include "scene/camera.h"

#include <Eigen/Geometry>
#include <cmath>

#include "scene/base/error.h"
#include "scene/camera_rays.h"

namespace airlight::scene {

Camera look_at(const Point3& position, const Point3& target, const Vec3& up) {
  // stableNorm: positions may be as far apart as numbers go without the squares overflowing.
  const Vec3 view = target - position;
  const double distance = view.stableNorm();
  if (!(distance > 0 && std::isfinite(distance)))
    throw Error("camera: look_at is the camera's position, expected another point");
  Camera camera;
  camera.position = position;
  camera.forward = (view / distance).normalized();
  const double up_length = up.stableNorm();
  if (!(up_length > 0 && std::isfinite(up_length))) throw Error("camera: up has no length, expected a direction");
  const Vec3 right = camera.forward.cross(up / up_length);
  // Closer than 1e-6 rad the roll of the image would hang on the last digits of the input.
  if (!(right.norm() > 1e-6)) throw Error("camera: up lies along the view, expected another direction");
  camera.right = right.normalized();
  camera.up = camera.right.cross(camera.forward).normalized();
  return camera;
}

Ray camera_ray(const Camera& camera, double x, double y, int width, int height) {
  return CameraRays(camera, width, height)(x, y);
}

}  // namespace airlight::scene
