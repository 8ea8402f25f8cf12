// Where a ray meets a triangle, a sphere or a plane, in double precision.
//
// The triangle test is watertight: after a shear that turns the ray into an axis (Woop, Benthin and Wald 2013), the
// three edge functions are evaluated with exact sign (a difference of products by fused multiply-add), and a ray that
// meets an edge or a vertex exactly is treated as if moved aside by an infinitesimal step, the same for all triangles.
// So a ray crosses a closed mesh an even number of times, in and out by turns, wherever it goes; a ray along a shared
// edge meets one of the two triangles, not both and not none.
#pragma once
#include <array>
#include <cmath>

#include "scene/geometry/surface.h"
#include "scene/math/types.h"

namespace airlight::scene {

// A ray prepared for many triangles.
struct ShearedRay {
  explicit ShearedRay(const Ray&);
  Point3 origin;
  int kx, ky, kz;     // kz: the largest component of the direction; handedness kept
  double sx, sy, sz;  // shear and 1/direction[kz]
};

// One crossing. The normal is unit and faces the ray's origin; `outward` says whether the surface's own orientation
// (counter-clockwise winding, outside of the sphere, normal of the plane) points the same way.
struct Crossing {
  double t = infinity;
  Point3 position;
  Vec3 normal;
  bool outward = true;
};

// a b - c d with relative error 2^-52 and the exact sign (barring underflow): Kahan's difference of products.
inline double difference_of_products(double a, double b, double c, double d) {
  const double ab = a * b, cd = c * d;
  return (ab - cd) + (std::fma(a, b, -ab) - std::fma(c, d, -cd));
}

// a x b, each component as accurate as above: the normal of a sliver is perpendicular to its edges to rounding.
inline Vec3 accurate_cross(const Vec3& a, const Vec3& b) {
  return {difference_of_products(a[1], b[2], a[2], b[1]), difference_of_products(a[2], b[0], a[0], b[2]),
          difference_of_products(a[0], b[1], a[1], b[0])};
}

// Each writes crossings with t > 0, in order of t, and returns how many there are.
int cross_triangle(const ShearedRay&, const Point3& a, const Point3& b, const Point3& c, Crossing&);  // 0 or 1
int cross_sphere(const Ray&, const Sphere&, std::array<Crossing, 2>&);                                // 0 to 2
int cross_plane(const Ray&, const Plane&, Crossing&);                                                 // 0 or 1

}  // namespace airlight::scene
