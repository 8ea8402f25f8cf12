#include "reference/froxel_fog/history.h"

#include <algorithm>
#include <cmath>

namespace airlight::froxel_fog {

std::optional<Froxel> History::at(const Point3& x) const {
  const scene::Camera& camera = view_.camera;
  const Vec3 from = x - camera.position;
  const double z = from.dot(camera.forward);
  const Interval range = volume_.slices().range();
  if (!(z >= range.lo && z <= range.hi)) return {};
  const bool parallel = camera.kind == scene::Camera::Kind::orthographic;
  const double half = parallel ? 0.5 * camera.height : z * std::tan(0.5 * camera.vertical_fov);
  const double aspect = double(view_.width) / view_.height;
  const double right = from.dot(camera.right) / (half * aspect), up = from.dot(camera.up) / half;
  if (!(std::abs(right) <= 1 && std::abs(up) <= 1)) return {};
  return volume_.froxel_at(0.5 * (1 + right) * view_.width, 0.5 * (1 - up) * view_.height, volume_.slices().encode(z));
}

}  // namespace airlight::froxel_fog
