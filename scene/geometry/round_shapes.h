// Procedural round shapes as triangle meshes: displaced sphere, torus, tube, prism. All are counter-clockwise seen from
// outside and closed unless their caps are left out.
//
// The numbers of vertices are those asked for, also where several lie in one place (a pole): tables of papers count
// them. Triangles without area are not made. All throw Error for sizes that are not positive and finite.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::scene {

// x = center + radii * u * (1 + sum of waves + sum of bumps) for every direction u, around the y axis.
struct DisplacedSphere {
  // amplitude * sin(wave_vector . u + phase)
  struct Wave {
    double amplitude;  // [-]
    Vec3 wave_vector;  // [rad]
    double phase;      // [rad]
  };
  // height * exp(-(angle between u and direction)^2 / width^2)
  struct Bump {
    Vec3 direction;  // unit
    double width;    // [rad], > 0
    double height;   // [-]
  };
  Point3 center = Point3::Zero();
  Vec3 radii = Vec3::Ones();  // [m], > 0
  int around = 64;            // vertices on each ring, >= 3
  int rings = 33;             // from pole to pole, both counted, >= 3
  std::vector<Wave> waves = {};
  std::vector<Bump> bumps = {};
};
TriangleMesh make_displaced_sphere(const DisplacedSphere&);  // around * rings vertices

struct Torus {
  Point3 center = Point3::Zero();
  Vec3 axis = Vec3::UnitY();  // unit
  double radius = 1;          // [m], of the circle in the middle of the tube
  double tube_radius = 0.2;   // [m], < radius
  int around = 64;            // vertices along the circle, >= 3
  int across = 32;            // around the tube, >= 3
};
TriangleMesh make_torus(const Torus&);  // around * across vertices

// A tube along a smooth curve through points (uniform Catmull-Rom: straight between two).
struct Tube {
  std::vector<Point3> path;  // at least 2, neighbours apart
  double radius = 0.1;       // [m], > 0, at the first point
  double end_radius = 0.1;   // at the last; linear in the parameter between them
  int along = 16;            // rings, >= 2
  int around = 16;           // vertices on each, >= 3
  bool caps = true;
};
TriangleMesh make_tube(const Tube&);  // along * around vertices

// A regular prism (a frustum if the radii differ) upright on its base; open as a ring without caps.
struct Prism {
  Point3 base = Point3::Zero();  // the middle of the bottom
  int sides = 6;                 // >= 3
  double radius = 1;             // [m], > 0, to the corners
  double top_radius = 1;         // [m], > 0
  double height = 1;             // [m], > 0
  bool caps = true;
};
TriangleMesh make_prism(const Prism&);  // 2 * sides vertices

}  // namespace airlight::scene
