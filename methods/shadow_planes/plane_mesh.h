// Shadow planes as meshes away from the light: Biri et al. 2006, section 5.1.5.
#pragma once
#include <array>
#include <vector>

#include "methods/shadow_planes/shadow_volumes.h"

namespace airlight::shadow_planes {

// A point of space, or a direction of points at infinity.
struct Vertex {
  Vec3 place;  // world [m]
  bool at_infinity = false;
};

// Every plane is a wedge of rays from the light through its edge. Each piece of the edge begins a row of `levels`
// strips, whose ends lie at distances in geometric progression between that of the edge and `far`, and one more to
// infinity. Strips are cut into two triangles.
class PlaneMesh {
 public:
  // `far` [m] from the light; where an edge is farther away than half of it, twice the edge's distance. Edges with
  // `left_out` have no vertices. Throws Error for more than 20 million.
  PlaneMesh(const ShadowVolumes&, const std::vector<char>& left_out, double far, int pieces, int levels);

  const std::vector<Vertex>& vertices() const { return vertices_; }
  std::size_t planes() const { return planes_; }  // pieces of edges

  // The triangle in which an edge's plane is crossed, linear over it also where it is endless: weights are those of
  // homogeneous coordinates, as of rasterised triangles with vertices at infinity.
  struct Place {
    std::array<int, 3> vertex;
    Vec3 weight;  // sum 1
  };
  Place locate(const Crossing&) const;

 private:
  struct Row {
    int first;     // vertex, of all pieces
    double ratio;  // logarithm of that between levels
  };
  int pieces_, levels_;
  std::size_t planes_ = 0;
  std::vector<Vertex> vertices_;
  std::vector<Row> rows_;  // by edge
};

}  // namespace airlight::shadow_planes
