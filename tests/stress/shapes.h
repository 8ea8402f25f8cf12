// Every shape that a scene may hold and that is a mesh inside, in a small form, and places on it.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::stress {

struct Spot {
  Point3 at;
  Vec3 out;  // to the front of all faces there
};

// A face's middle, an edge's middle and a vertex of a mesh, with the mean of the normals there.
inline std::vector<Spot> spots(const scene::TriangleMesh& mesh, std::size_t triangle) {
  const auto normal_of = [&](const std::array<int, 3>& t) {
    return Vec3((mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  };
  const auto& t = mesh.triangles[triangle % mesh.triangles.size()];
  const Point3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
  Vec3 edge = Vec3::Zero(), vertex = Vec3::Zero();
  for (const auto& other : mesh.triangles) {
    const auto has = [&](const Point3& p) {
      for (const int v : other)
        if ((mesh.vertices[v] - p).norm() < 1e-9) return true;
      return false;
    };
    if (has(a)) vertex += normal_of(other).normalized();
    if (has(a) && has(b)) edge += normal_of(other).normalized();
  }
  return {{(a + b + c) / 3, normal_of(t).normalized()}, {0.5 * (a + b), edge.normalized()}, {a, vertex.normalized()}};
}

inline const char* const mesh_shapes[] = {
    "type = 'box'\nlo = [-1, -0.5, -1]\nhi = [1, 0.7, 1]\ntransform = { rotation = { euler = [0.2, 0.8, 0] } }",
    "type = 'prism'\nsides = 7\nradius = 1\nheight = 0.8",
    ("type = 'height_field'\nsize = [5, 4]\nspacing = [1, 1]\norigin = [-2, 0, -1.5]\n"
     "waves = [{ amplitude = 0.3, wave_vector = [1, 2] }]"),
    "type = 'displaced_sphere'\nradius = 1\nsize = [16, 9]\nwaves = [{ amplitude = 0.05, wave_vector = [3, 2, 1] }]",
    "type = 'torus'\nradius = 1\ntube_radius = 0.4\nsize = [16, 12]",
    "type = 'tube'\npath = [[-1, 0, 0], [0, 0.3, 0], [1, 0, 0.5]]\nradius = 0.4\nsize = [8, 8]",
    "type = 'teapot'\nsize = 5\ntransform = { scale = 0.6 }",
    "type = 'city'\norigin = [-1, 0, -1]\nboxes = 4\ncolumns = 2\nlot = 0.8\nstreet = 0.3\nheights = [0.5, 1]",
};

}  // namespace airlight::stress
