// Triangles as shaders test rays against them: raster/tree.glsl.
#pragma once
#include <array>
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::gpu {

struct OccluderNode {
  std::array<float, 3> lo;
  int behind;  // the node that follows when this one is missed
  std::array<float, 3> hi;
  int leaf;  // 8 * first triangle + their number; of a branch -1 - (4 * second child + axis of the cut), the first follows
};
struct OccluderTriangle {
  std::array<float, 4> a, b, c;  // a[3]: bits of its number among all triangles of the scene
};
struct Occluders {
  std::vector<OccluderNode> nodes;  // depth first
  std::vector<OccluderTriangle> triangles;
};

// Positions relative to `middle`. Branches are cut at the median of the centres along the longest side; at most 4
// triangles in a leaf; boxes are widened by more than the rounding of a ray in single precision.
Occluders make_occluders(const std::vector<scene::Surface>&, const Point3& middle);

}  // namespace airlight::gpu
