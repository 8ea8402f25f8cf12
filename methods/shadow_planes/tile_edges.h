// Which silhouette edges the rays of a tile of pixels may cross.
#pragma once
#include <vector>

#include "methods/shadow_planes/shadow_volumes.h"
#include "scene/renderer.h"

namespace airlight::shadow_planes {

inline constexpr int tile_side = 16;  // pixels

// A vertex lies on the side of the plane through ray and light that a function says which is linear over the film.
// So an edge whose ends are on one side at the four corners of a tile is crossed by none of its rays. Conservative and
// exact: no clipping of infinite planes. Tiles are searched by way of blocks of 8 x 8 of them.
class TileEdges {
 public:
  // Searches the blocks, on all threads. Keeps a reference to the first.
  TileEdges(const ShadowVolumes&, const scene::View&, int threads);

  // Their numbers, ascending.
  void of_tile(int tile_x, int tile_y, std::vector<int>& edges) const;

 private:
  static constexpr int tiles = 8;  // of a block
  void select(int side, int x, int y, const std::vector<int>& candidates, std::vector<int>& edges) const;

  const ShadowVolumes& shadows_;
  scene::View view_;
  int columns_;
  std::vector<std::vector<int>> blocks_;
};

}  // namespace airlight::shadow_planes
