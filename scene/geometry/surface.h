// Surfaces and their materials.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "scene/math/types.h"
#include "scene/media/region.h"

namespace airlight::scene {

struct Lambert {
  Rgb albedo = Rgb::Constant(0.5);  // in [0, 1]
};
// Modified Phong lobe, energy-conserving: diffuse/pi + specular (n+2)/(2 pi) max(0, cos(reflected, out))^n; diffuse +
// specular <= 1.
struct Phong {
  Rgb diffuse = Rgb::Constant(0.4);
  Rgb specular = Rgb::Constant(0.2);
  double exponent = 20;  // >= 0
};
class BrdfTable;
// Any isotropic reflectance, in a table (brdf_table.h).
struct Tabulated {
  std::shared_ptr<const BrdfTable> table;  // never null
};
using Material = std::variant<Lambert, Phong, Tabulated>;

// Reflectance f(in, out) [1/sr]; `in` and `out` unit, both away from the surface, `normal` on their side. Zero below
// the horizon.
Rgb brdf(const Material&, const Vec3& normal, const Vec3& in, const Vec3& out);

struct TriangleMesh {
  std::vector<Point3> vertices;               // world
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from outside
  int removed_degenerate = 0;                 // zero-area triangles dropped at load
};

// An infinite plane, two-sided.
struct Plane {
  Point3 point = Point3::Zero();
  Vec3 normal = Vec3::UnitY();  // unit
};

// Spheres and planes are met analytically; boxes and height fields become meshes at load.
using Shape = std::variant<TriangleMesh, Sphere, Plane>;

struct Surface {
  std::string name;
  Shape shape;
  Material material;
};

}  // namespace airlight::scene
