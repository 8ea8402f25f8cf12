#include "methods/fogshop/authoring/screen.h"

#include <cmath>

namespace airlight::fogshop::authoring {

std::optional<Point3> unproject(const View& view, const ScreenPoint& p, const Canvas& canvas) {
  const Ray ray = scene::camera_ray(view.camera, p[0], p[1], view.width, view.height);
  const double slope = canvas.normal.dot(ray.direction);
  if (slope == 0) return std::nullopt;
  const double t = (canvas.d - canvas.normal.dot(ray.origin)) / slope;
  if (!(t > 0) || !std::isfinite(t)) return std::nullopt;
  return ray.at(t);
}

std::optional<ScreenPoint> project(const View& view, const Point3& x, double near) {
  const scene::Camera& camera = view.camera;
  const Vec3 v = x - camera.position;
  const double depth = v.dot(camera.forward);
  if (!(depth > near)) return std::nullopt;
  const bool flat = camera.kind == scene::Camera::Kind::orthographic;
  const double half = flat ? 0.5 * camera.height : depth * std::tan(0.5 * camera.vertical_fov);
  const double aspect = double(view.width) / view.height;
  return ScreenPoint(0.5 * view.width * (1 + v.dot(camera.right) / (half * aspect)),
                     0.5 * view.height * (1 - v.dot(camera.up) / half));
}

std::vector<Id> select(const GaussianList& list, const View& view, const ScreenPoint& lo, const ScreenPoint& hi,
                       double near) {
  std::vector<Id> ids;
  for (const Gaussian& gaussian : list.all()) {
    const auto p = project(view, gaussian.b, near);
    if (p && (p->array() >= lo.array()).all() && (p->array() < hi.array()).all()) ids.push_back(gaussian.id);
  }
  return ids;
}

}  // namespace airlight::fogshop::authoring
