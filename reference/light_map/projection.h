// Where the texels of a light's map look, and where a point lies on the map.
//
// A directional light has parallel rays (orthographic): the map covers the rectangle that a box of the media leaves on a
// plane across the light, its sides along one edge of the box, whichever makes the rectangle least. A point or spot
// light has rays in all directions (octahedral map: Engelhardt and Dachsbacher 2008), or, where the light is outside the
// box or shines into a cone, in a cap around the axis of the octahedron, which is the middle of the map.
//
// Texel (i, j) is centred at i + 0.5, j + 0.5 of `size`. Depth: distance along the ray [m], from where the box begins to
// where it ends.
#pragma once
#include "scene/light/light.h"
#include "scene/math/types.h"

namespace airlight::light_map {

struct Projection {
  enum class Kind { orthographic, octahedral } kind = Kind::orthographic;
  int size = 1;                   // texels a side
  Mat3 axes = Mat3::Identity();   // rows: the map's x, its y, and the light's propagation or the octahedron's axis
  Point3 light = Point3::Zero();  // octahedral: where the light is
  Interval across[2] = {};        // orthographic: of x and y along their axes [m]
  double reach = 1;               // octahedral: half the side of the map's square; 1: the whole sphere
  Interval depth = {};            // [m]

  bool whole_sphere() const { return kind == Kind::octahedral && reach == 1; }
};

// For a light that shines from one direction (is_delta), and a box that is not empty and has an end on every side.
Projection fit(const scene::Light&, const Box&, int size);

// The ray of a texel. Its parameter is the depth.
Ray texel_ray(const Projection&, int i, int j);

struct Place {
  double x = 0, y = 0;  // [texels], in [0, size]
  double depth = 0;     // share of the projection's depths in [0, 1]; 0 before it and beside the map
};
Place place(const Projection&, const Point3&);

// A point may lie so far beside the map, by rounding, and count as on its edge [texels].
constexpr double slack = 1e-3;

}  // namespace airlight::light_map
