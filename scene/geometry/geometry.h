// Ray queries against the surfaces of a scene, by Embree. A scene without surfaces has no Geometry at all: nothing is
// called.
//
// Embree finds the candidates (candidate_tree.h); whether and where a triangle or sphere is met is decided in double,
// watertight (ray_primitive.h). Infinite planes are few and tested one by one. So the answers do not depend on threads
// or instruction set, scale bit by bit with a scene that is scaled by a power of two, and are exact to the rounding of
// the coordinates however far the scene or the ray's origin is away. Two-sided surfaces. Const calls are thread safe.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "scene/geometry/surface.h"
#include "scene/math/types.h"

namespace airlight::scene {

struct Hit {
  double t;         // [m] along the ray
  Point3 position;  // on the surface
  Vec3 normal;      // unit, geometric, on the side of the ray's origin
  int surface;      // index into the surfaces
  int triangle;     // of the surface's mesh; -1 on other shapes
};

class Geometry {
 public:
  explicit Geometry(const std::vector<Surface>&);  // throws Error for an index out of range or a non-finite vertex
  ~Geometry();

  // Nearest hit with 0 < t < tmax. An origin that lies on a surface must be moved off it first (offset_origin).
  std::optional<Hit> first_hit(const Ray&, double tmax = infinity) const;
  // Is anything in 0 < t < tmax?
  bool occluded(const Ray&, double tmax = infinity) const;
  // All crossings in order of t. A ray through a shared edge or vertex of a closed mesh crosses it as one moved aside
  // by an infinitesimal step would: in and out by turns. Triangles that are there twice count once.
  std::vector<Hit> all_hits(const Ray&, double tmax = infinity) const;
  // Moves a point on a surface to the side of `direction` by 32 ulp of the scene's largest coordinate.
  Point3 offset_origin(const Point3& position, const Vec3& normal, const Vec3& direction) const;

  Box bounds() const;  // of the finite surfaces
  const std::vector<Surface>& surfaces() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace airlight::scene
