// Meshes and rays for the tests of ray queries.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "scene/geometry/geometry.h"
#include "scene/geometry/ray_primitive.h"

namespace airlight::scene {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Random {
  std::mt19937_64 engine{3};
  double uniform(double lo = 0, double hi = 1) { return std::uniform_real_distribution<double>(lo, hi)(engine); }
  Vec3 direction() {
    for (;;) {
      const Vec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }
  Point3 in(const Box& box) {
    return {uniform(box.lo[0], box.hi[0]), uniform(box.lo[1], box.hi[1]), uniform(box.lo[2], box.hi[2])};
  }
};

// A closed mesh with concavities and shared vertices: a torus.
inline TriangleMesh torus(int n, int m) {
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      const double a = 2 * pi * i / n, b = 2 * pi * k / m, r = 1 + 0.4 * std::cos(b);
      mesh.vertices.emplace_back(r * std::cos(a), 0.4 * std::sin(b), -r * std::sin(a));
    }
  const auto at = [&](int i, int k) { return (i % n) * m + k % m; };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

inline double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]])) / 6;
  return sum;
}

inline TriangleMesh moved(TriangleMesh mesh, double scale, const Vec3& shift) {
  for (Point3& v : mesh.vertices) v = scale * v + shift;
  return mesh;
}

inline Surface surface_of(Shape shape) { return {"thing", std::move(shape), Lambert{}}; }

// Rays that look for trouble: at vertices, along edges, through edge midpoints, along the axes, and at random.
inline std::vector<Ray> hard_rays(const TriangleMesh& mesh, const Box& around, int count, Random& random) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const auto& t = mesh.triangles[random.engine() % mesh.triangles.size()];
    const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]];
    const Point3 origin = random.in(around);
    rays.push_back({origin, (a - origin).normalized()});
    rays.push_back({origin, (0.5 * (a + b) - origin).normalized()});
    rays.push_back({a + 20 * (a - b), (b - a).normalized()});
    for (int axis = 0; axis < 3; ++axis) {  // exactly through a vertex
      Ray ray{a, Vec3::Unit(axis)};
      ray.origin[axis] = -8;
      rays.push_back(ray);
    }
    rays.push_back({origin, random.direction()});
  }
  return rays;
}

// All triangles, one by one, without the tree.
inline std::vector<Crossing> brute_force(const TriangleMesh& mesh, const Ray& ray) {
  const ShearedRay sheared(ray);
  std::vector<Crossing> crossings;
  for (const auto& t : mesh.triangles) {
    Crossing crossing;
    if (cross_triangle(sheared, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], crossing))
      crossings.push_back(crossing);
  }
  std::sort(crossings.begin(), crossings.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  return crossings;
}

inline bool same_bits(const Hit& a, const Hit& b) {
  return a.t == b.t && a.position == b.position && a.normal == b.normal && a.surface == b.surface;
}

}  // namespace airlight::scene
