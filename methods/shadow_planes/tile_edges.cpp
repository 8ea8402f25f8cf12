#include "methods/shadow_planes/tile_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace airlight::shadow_planes {

void edges_of_tile(const ShadowVolumes& shadows, const scene::View& view, int tile_x, int tile_y,
                   std::vector<int>& edges) {
  std::array<Vec3, 4> side;
  for (int corner = 0; corner < 4; ++corner) {
    const double x = std::min(view.width, tile_side * (tile_x + (corner & 1)));
    const double y = std::min(view.height, tile_side * (tile_y + (corner >> 1)));
    const Ray ray = camera_ray(view.camera, x, y, view.width, view.height);
    side[corner] = ray.direction.cross(shadows.light() - ray.origin);
  }
  edges.clear();
  for (int i = 0; i < int(shadows.edges().size()); ++i) {
    const SilhouetteEdge& edge = shadows.edges()[i];
    int positive = 0;
    for (const Vec3& s : side) positive += (s.dot(edge.a) >= 0) + (s.dot(edge.b) >= 0);
    if (positive > 0 && positive < 8) edges.push_back(i);
  }
}

}  // namespace airlight::shadow_planes
