// Which parts of a view ray a delta light can see.
#pragma once
#include <array>
#include <vector>

#include "reference/deterministic/light_plane.h"
#include "scene/geometry/geometry.h"

namespace airlight::deterministic {

// The surfaces of a scene, prepared for shadow boundaries. Spheres, planes and meshes of up to `exact_triangles`
// triangles are exact: every boundary is the shadow of an edge or a tangent. Larger meshes are sampled at `samples`
// points per ray and bisected where neighbours differ: gaps or shadows shorter than a sample's spacing can be missed,
// and boundaries are as good as the single precision of the ray queries.
class ShadowFinder {
 public:
  static constexpr int exact_triangles = 20000;
  ShadowFinder(const scene::Geometry&, int samples);

  bool exact() const { return exact_; }

  // Lit stretches within [range.lo, range.hi] (hi may be infinite), in order.
  std::vector<Interval> lit(const LightPlane&, Interval range) const;

 private:
  bool visible(const LightPlane&, double t) const;
  void split(const LightPlane&, double lo, double hi, bool lo_lit, bool hi_lit,
             std::vector<std::pair<double, bool>>&) const;

  const scene::Geometry& geometry_;
  int samples_;
  bool exact_ = true;
  std::vector<std::array<Point3, 2>> edges_;
};

}  // namespace airlight::deterministic
