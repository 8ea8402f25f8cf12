// Procedural shapes as triangle meshes: boxes and height fields.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::scene {

// The twelve triangles of a box, counter-clockwise seen from outside; eight shared vertices. Throws Error if a side of
// the box is not positive and finite.
TriangleMesh make_box(const Box&);

// A terrain over the plane y = origin.y: vertex (i, k) lies at origin + (i * spacing_x, heights[i + nx * k], k *
// spacing_z). Two triangles per cell, counter-clockwise seen from above, cut along the diagonal from (i, k) to (i + 1,
// k + 1). Open at the sides.
struct HeightField {
  int nx = 0;  // vertices along x, >= 2
  int nz = 0;  // vertices along z, >= 2
  Point3 origin = Point3::Zero();
  double spacing_x = 1;  // [m], > 0
  double spacing_z = 1;
  std::vector<double> heights;  // [m], nx * nz, x fastest; finite
};

// Throws Error if the sizes do not fit or a height is not finite.
TriangleMesh make_height_field(const HeightField&);

}  // namespace airlight::scene
