#include "scene/light/light_on_ray.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::scene {
namespace {

// The pixel whose centre's ray passes closest to x; nothing behind the camera or beside the film.
bool pixel_of(const View& view, const Point3& x, int pixel[2]) {
  const Camera& c = view.camera;
  const Vec3 to = x - c.position;
  const double depth = to.dot(c.forward);
  if (!(depth > 0)) return false;
  const bool perspective = c.kind == Camera::Kind::perspective;
  const double half = perspective ? std::tan(0.5 * c.vertical_fov) * depth : 0.5 * c.height;
  const double across = (to.dot(c.right) / half * view.height / view.width + 1) / 2 * view.width;
  const double down = (1 - to.dot(c.up) / half) / 2 * view.height;
  if (!(across >= 0 && across < view.width && down >= 0 && down < view.height)) return false;
  pixel[0] = int(across), pixel[1] = int(down);
  return true;
}

}  // namespace

void require_lights_apart(const Scene& scene, const View& view, double share, const std::string& who) {
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const auto light = ball(scene.lights[l]);
    int pixel[2];
    if (!light || light->radius > 0 || !pixel_of(view, light->center, pixel)) continue;
    if (!(extinction(scene.media, light->center) > 0).any()) continue;
    const Ray ray = camera_ray(view.camera, pixel[0] + 0.5, pixel[1] + 0.5, view.width, view.height);
    const Vec3 to = light->center - ray.origin;
    const double t = to.dot(ray.direction), beside = (to - t * ray.direction).norm();
    if (beside >= share * t || camera_end(scene, ray).t < t) continue;
    throw Error(
        fmt::format("{}: light {} stands {:.3g} m beside the ray of pixel ({}, {}), closer than it can tell; "
                    "expected {:.3g} m or a radius",
                    who, l, beside, pixel[0], pixel[1], share * t));
  }
}

}  // namespace airlight::scene
