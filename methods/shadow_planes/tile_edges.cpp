#include "methods/shadow_planes/tile_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "methods/shadow_planes/general_origin.h"

namespace airlight::shadow_planes {

TileEdges::TileEdges(const ShadowVolumes& shadows, const scene::View& view, int threads)
    : shadows_(shadows), view_(view), columns_((view.width + tiles * tile_side - 1) / (tiles * tile_side)) {
  const int rows = (view.height + tiles * tile_side - 1) / (tiles * tile_side);
  blocks_.resize(std::size_t(columns_) * rows);
  scene::parallel_rows(columns_ * rows, {threads, {}}, [&](int block) {
    select(tiles * tile_side, block % columns_, block / columns_, shadows.all_edges(), blocks_[block]);
  });
}

void TileEdges::of_tile(int tile_x, int tile_y, std::vector<int>& edges) const {
  select(tile_side, tile_x, tile_y, blocks_[std::size_t(tile_y / tiles) * columns_ + tile_x / tiles], edges);
}

void TileEdges::select(int side, int x, int y, const std::vector<int>& candidates, std::vector<int>& edges) const {
  std::array<Vec3, 4> planes;
  for (int corner = 0; corner < 4; ++corner) {
    const double film_x = std::min(view_.width, side * (x + (corner & 1)));
    const double film_y = std::min(view_.height, side * (y + (corner >> 1)));
    const Ray ray = camera_ray(view_.camera, film_x, film_y, view_.width, view_.height);
    planes[corner] = ray.direction.cross(shadows_.light() - general_origin(ray.origin, shadows_.light()));
  }
  edges.clear();
  for (const int i : candidates) {
    const SilhouetteEdge& edge = shadows_.edges()[i];
    int positive = 0;
    for (const Vec3& s : planes) positive += (s.dot(edge.a) >= 0) + (s.dot(edge.b) >= 0);
    if (positive > 0 && positive < 8) edges.push_back(i);
  }
}

}  // namespace airlight::shadow_planes
