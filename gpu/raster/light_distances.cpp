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
      distances_(context, "light-distance maps", positions.size() * 6 * side * side * 4),
      primitives_(context, "light-distance maps, primitives", positions.size() * 6 * side * side * 4) {
  const Use use(context);
  const FirstHits pass(context, scene, false);
  std::size_t first = 0;
  for (const Point3& position : positions)
    for (int face = 0; face < 6; ++face) {
      pass.find(face_view(position, face, side), distances_, &primitives_, {1, first});
      first += std::size_t(side) * side;
    }
}

}  // namespace airlight::gpu
