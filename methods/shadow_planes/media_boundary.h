// The boundary of a convex medium as a mesh: Biri et al. 2006, section 5.2.
#pragma once
#include <array>
#include <vector>

#include "scene/math/types.h"
#include "scene/media/region.h"

namespace airlight::shadow_planes {

// A cube's six faces in cells * cells squares of two triangles each, put onto a box, or onto a sphere from its centre.
class MediaBoundary {
 public:
  MediaBoundary(const scene::Region&, int cells);  // requires a box or a sphere

  const std::vector<Point3>& vertices() const { return vertices_; }  // world; each face has its own
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

  // The triangle in front of a point of the boundary, seen from the middle, and the weights of its vertices.
  struct Place {
    int triangle;
    Vec3 weight;  // sum 1
  };
  Place locate(const Point3&) const;

 private:
  int cells_;
  Point3 centre_;
  Vec3 half_;
  std::vector<Point3> vertices_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace airlight::shadow_planes
