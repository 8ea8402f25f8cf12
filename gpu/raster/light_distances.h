// Views from every point or spot light: light-distance maps, cube maps of first distances and of the
// primitives that are met.
//
// Six raster passes per light, by the code of the camera's (first_hits.h): no near plane and no bias. Distances are
// those along the rays through the texels' centres. Shadows (raster/light_distances.glsl) compare no distances: they
// test the primitives of the nine texels around a direction exactly, and where none of them blocks the ray, all others
// by a tree of boxes (shadow_tree.h). So shadows are those of the geometry, whatever the maps' resolution.
#pragma once
#include <vector>

#include "gpu/raster/first_hits.h"

namespace airlight::gpu {

class LightDistances {
 public:
  // `positions` [m], one map each, `side` texels to a face's side, >= 1. Throws Unavailable above the device's limits:
  // a map takes 24 side^2 bytes in each of two buffers.
  LightDistances(Context&, const scene::Scene&, const std::vector<Point3>& positions, int side);

  // Draws the maps of lights that stand elsewhere now, as many lights as before, among the same surfaces: how many.
  int move(const std::vector<Point3>& positions);

  int side() const { return side_; }
  int texels_per_light() const { return 6 * side_ * side_; }
  const Buffer& distances() const { return distances_; }    // [m], far_away where there is nothing
  const Buffer& primitives() const { return primitives_; }  // triangles in their order, then solids; -1: nothing

  // Faces in order +x, -x, +y, -y, +z, -z. Texel (i, j) of a face, j = 0 its top row, looks along this ray.
  static scene::View face_view(const Point3& position, int face, int side);

 private:
  void draw(std::size_t light);

  int side_;
  FirstHits pass_;
  std::vector<Point3> positions_;
  Buffer distances_, primitives_;
};

}  // namespace airlight::gpu
