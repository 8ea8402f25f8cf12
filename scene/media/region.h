// The part of space that a medium fills: everything, a box, a sphere or a slab. Closed sets.
#pragma once
#include <optional>
#include <string>
#include <variant>

#include "scene/math/types.h"

namespace airlight::scene {

struct Unbounded {};
struct Sphere {
  Point3 center = Point3::Zero();
  double radius = 1;  // [m], > 0
};
// lo <= dot(normal, x) <= hi.
struct Slab {
  Vec3 normal = Vec3::UnitY();  // unit length
  double lo = 0;
  double hi = 1;  // [m]
};

using Region = std::variant<Unbounded, Box, Sphere, Slab>;

// The part of [t0, t1] of the ray that lies inside; empty if none. t1 may be infinite, and the answer then too.
Interval clip(const Region&, const Ray&, Interval);

bool contains(const Region&, const Point3&);

// The smallest box around the region; sides of an unbounded one are infinite.
Box bounding_box(const Region&);

std::string region_name(const Region&);  // "unbounded", "box", "sphere", "slab"

}  // namespace airlight::scene
