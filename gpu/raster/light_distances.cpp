#include "gpu/raster/light_distances.h"

namespace airlight::gpu {

scene::View LightDistances::face_view(const Point3& position, int face, int side) {
  const int axis = face / 2;
  const double sign = face % 2 == 0 ? 1 : -1;
  scene::Camera camera;
  camera.position = position;
  camera.forward = sign * Vec3::Unit(axis);
  camera.up = Vec3::Unit((axis + 1) % 3);
  camera.right = sign * Vec3::Unit((axis + 2) % 3);
  camera.vertical_fov = pi / 2;
  return {camera, side, side};
}

LightDistances::LightDistances(Context& context, const scene::Scene& scene, const std::vector<Point3>& positions,
                               int side)
    : side_(side),
      pass_(context, scene, false),
      positions_(positions),
      distances_(context, "light-distance maps", positions.size() * 6 * side * side * 4),
      primitives_(context, "light-distance maps, primitives", positions.size() * 6 * side * side * 4) {
  for (std::size_t l = 0; l < positions.size(); ++l) draw(l);
}

int LightDistances::move(const std::vector<Point3>& positions) {
  int moved = 0;
  for (std::size_t l = 0; l < positions_.size(); ++l) {
    if (positions_[l] == positions[l]) continue;
    positions_[l] = positions[l];
    draw(l);
    ++moved;
  }
  return moved;
}

void LightDistances::draw(std::size_t light) {
  for (int face = 0; face < 6; ++face) {
    const std::size_t first = (6 * light + std::size_t(face)) * std::size_t(side_) * std::size_t(side_);
    pass_.find(face_view(positions_[light], face, side_), distances_, &primitives_, {1, first});
  }
}

}  // namespace airlight::gpu
