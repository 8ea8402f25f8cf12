#include "scene/backdrop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/renderer.h"

namespace airlight::scene {

std::optional<SeenPoint> seen_along(const Backdrop& backdrop, const Camera& camera, const Ray& ray) {
  const bool perspective = camera.kind == Camera::Kind::perspective;
  const double ahead = ray.direction.dot(camera.forward);
  if (!(ahead > 0)) return {};
  // On the film, in units of half its height.
  const Vec3 across = perspective ? Vec3(ray.direction / ahead) : Vec3(ray.origin - camera.position);
  const double half = perspective ? std::tan(0.5 * camera.vertical_fov) : 0.5 * camera.height;
  const double sx = across.dot(camera.right) / half, sy = across.dot(camera.up) / half;
  const double x = 0.5 * (backdrop.width + sx * backdrop.height), y = 0.5 * (1 - sy) * backdrop.height;
  // Between two pixels, as centres of a film of half the size lie, the right and lower one, whatever the rounding.
  constexpr double tie = 1e-6;
  const auto column = std::size_t(std::clamp(std::floor(x + tie), 0.0, backdrop.width - 1.0));
  const auto row = std::size_t(std::clamp(std::floor(y + tie), 0.0, backdrop.height - 1.0));
  const std::size_t pixel = row * std::size_t(backdrop.width) + column;
  const double depth = backdrop.depth[pixel];
  if (depth == infinity && !backdrop.fills) return {};
  const float* rgb = &backdrop.radiance[3 * pixel];
  return SeenPoint{depth / ahead, Rgb(rgb[0], rgb[1], rgb[2])};
}

void require_own_camera(const Scene& scene, const View& view) {
  if (scene.backdrops.empty()) return;
  const Camera &own = scene.camera, &other = view.camera;
  if (own.kind == other.kind && own.position == other.position && own.forward == other.forward && own.up == other.up &&
      own.right == other.right && own.vertical_fov == other.vertical_fov && own.height == other.height)
    return;
  throw Error(fmt::format("{}: a backdrop belongs to the scene's own camera, and this view is another", scene.name));
}

void refuse_backdrops(const Scene& scene, std::vector<std::string>& reasons) {
  if (!scene.backdrops.empty())
    reasons.push_back("a backdrop or particles end camera rays, and this method knows surfaces alone");
}

}  // namespace airlight::scene
