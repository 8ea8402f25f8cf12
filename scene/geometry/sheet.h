// A rectangle of vertices as a mesh: what every parametric surface is made of.
#pragma once
#include <Eigen/Geometry>

#include "scene/geometry/surface.h"

namespace airlight::scene {

// Adds nu * nv vertices position(i, k), i fastest, and two triangles for every four neighbours, whose normal is
// d/dk x d/di; the ends of a wrapped index are neighbours too. Triangles without area (at a pole) are not made.
template <class F>
void add_sheet(TriangleMesh& mesh, int nu, int nv, bool wrap_u, bool wrap_v, F position) {
  const int first = int(mesh.vertices.size());
  for (int k = 0; k < nv; ++k)
    for (int i = 0; i < nu; ++i) mesh.vertices.push_back(position(i, k));
  const auto triangle = [&](int a, int b, int c) {
    const Point3 &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    if ((q - p).cross(r - p).squaredNorm() > 0) mesh.triangles.push_back({a, b, c});
  };
  for (int k = 0; k < (wrap_v ? nv : nv - 1); ++k)
    for (int i = 0; i < (wrap_u ? nu : nu - 1); ++i) {
      const int i1 = (i + 1) % nu, k1 = (k + 1) % nv;
      const int a = first + i + nu * k, b = first + i1 + nu * k, c = first + i + nu * k1, d = first + i1 + nu * k1;
      triangle(a, c, d);
      triangle(a, d, b);
    }
}

// A fan over the polygon of the vertices first .. first + count - 1; `flipped` turns it around.
inline void add_cap(TriangleMesh& mesh, int first, int count, bool flipped) {
  for (int i = 1; i + 1 < count; ++i)
    mesh.triangles.push_back({first, first + i + (flipped ? 1 : 0), first + i + (flipped ? 0 : 1)});
}

}  // namespace airlight::scene
