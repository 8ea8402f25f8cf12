// Edges of a mesh whose planes with a light bound its shadow: Biri et al. 2006, section 5.1, stage 1.
#pragma once
#include <array>
#include <vector>

#include "scene/geometry/surface.h"
#include "scene/math/types.h"

namespace airlight::shadow_planes {

// A mesh by its edges. Vertices at the same place are one, so that a seam of the file is no border. Triangles are those
// that rays meet (scene/geometry/clean_mesh.h): with the same corners in the same order they count once, one that is
// there from both sides twice.
class MeshEdges {
 public:
  explicit MeshEdges(const scene::TriangleMesh&);

  struct Side {
    int triangle;
    bool forward;  // the triangle runs from a to b
  };
  struct Edge {
    int a, b;
    int first, count;  // of its sides: two inside a surface, one on a border, more where surfaces meet
  };
  const std::vector<Point3>& vertices() const { return vertices_; }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  int number(int triangle) const { return numbers_[triangle]; }  // in the mesh
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Side>& sides() const { return sides_; }

 private:
  std::vector<Point3> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> numbers_;
  std::vector<Edge> edges_;
  std::vector<Side> sides_;
};

// From a to b, relative to the light; seen from there the shadow is on the left. Crossing its plane changes the number
// of surfaces between a point and the light by `multiplicity`: 2 for a closed mesh, 1 on a border.
struct SilhouetteEdge {
  Vec3 a, b;  // [m]
  int multiplicity;
};

// Does the light, at the origin, see the side of a triangle from which its corners run counter-clockwise? A light that
// lies in the plane up to rounding counts as seeing it.
bool faces_light(const Vec3& a, const Vec3& b, const Vec3& c);

// Every triangle is turned to face the light, and an edge counts by how often it is run along more often one way than
// the other. So it needs neither closed meshes nor agreeing windings, and the light may be inside.
std::vector<SilhouetteEdge> silhouette(const MeshEdges&, const Point3& light);

}  // namespace airlight::shadow_planes
