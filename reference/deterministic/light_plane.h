// The plane through a view ray and a delta light, where everything that matters to the light path of a ray happens.
//
// Each function adds the ray parameters t at which light paths graze something: there the optical depth towards the
// light, or the visibility, has a kink or a jump. Extra values do no harm: they only cut the quadrature.
#pragma once
#include <optional>
#include <vector>

#include "reference/deterministic/density_along_ray.h"
#include "scene/geometry/surface.h"
#include "scene/light/light.h"
#include "scene/media/medium.h"

namespace airlight::deterministic {

struct LightPlane {
  Ray ray;
  bool directional = false;
  Vec3 to_light;       // directional: unit
  Point3 light;        // else: position
  double foot = 0;     // ray parameter of the point nearest to the light; not for directional
  double h = 0;        // distance there [m]
  Vec3 normal_to_ray;  // unit, from the foot to the light, or the part of to_light across the ray; zero if h = 0
  Vec3 plane_normal;   // unit; zero if the ray points at the light or away from it
  bool degenerate() const { return plane_normal.isZero(0); }
  Vec3 towards_light(double t) const;  // unit
};
LightPlane light_plane(const Ray&, const scene::Light&);

// Lines from the light that touch the sphere.
void add_tangents(const LightPlane&, const Point3& center, double radius, std::vector<double>& t);
// The line from the light through the point where the edge [a, b] meets the plane.
void add_edge(const LightPlane&, const Point3& a, const Point3& b, std::vector<double>& t);
// Where a spot's inner and outer cone cut the ray.
void add_cone(const LightPlane&, const scene::SpotLight&, std::vector<double>& t);
// Region and grid borders of a medium.
void add_medium(const LightPlane&, const scene::Medium&, std::vector<double>& t);
// Where Gaussians of the table lie between light and ray, with the width of their shadows there; those whose optical
// depth sigma * (line integral) stays below `skip` are left out.
void add_gaussian_shadows(const LightPlane&, const GaussianTable&, double sigma, double skip, std::vector<Feature>&);

}  // namespace airlight::deterministic
