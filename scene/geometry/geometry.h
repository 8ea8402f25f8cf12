// Ray queries against the surfaces of a scene, by Embree. A scene without surfaces has no Geometry at all: nothing is
// called.
//
// Embree works in float: coordinates are recentred and scaled to the unit box first (by a power of two), and hit points
// are refined in double against the exact primitive. Two-sided surfaces.
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
};

class Geometry {
 public:
  explicit Geometry(const std::vector<Surface>&);  // throws Error for an index out of range or a non-finite vertex
  ~Geometry();

  // Nearest hit with 0 < t < tmax. An origin that lies on a surface must be moved off it first (offset_origin).
  std::optional<Hit> first_hit(const Ray&, double tmax = infinity) const;
  // Is anything in 0 < t < tmax?
  bool occluded(const Ray&, double tmax = infinity) const;
  // All crossings in order of t, duplicates on shared edges merged.
  std::vector<Hit> all_hits(const Ray&, double tmax = infinity) const;
  // Moves a point on a surface to the side of `direction` by a few ulp of the scene's coordinates.
  Point3 offset_origin(const Point3& position, const Vec3& normal, const Vec3& direction) const;

  Box bounds() const;  // of the finite surfaces
  const std::vector<Surface>& surfaces() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace airlight::scene
