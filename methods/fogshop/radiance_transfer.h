// Precomputed radiance transfer of static meshes: which directions other surfaces hide from a point, in spherical
// harmonics. Zhou et al. 2007, V_p of Eq. 20, after Sloan et al. 2002.
//
// Computed at the vertices, interpolated over the triangle of a hit. It shadows scattered light, and all light of
// environments; direct light of points keeps its exact test. Directions that point into the surface at a vertex (below
// the horizon of every face there) count as open: the reflectance is 0 in them, and so a convex mesh shadows itself not
// at all instead of by what harmonics cut off at a band make of its horizon.
//
// Inter-reflection (section 4.3: a PRT vector says how an object "shadows and inter-reflects light onto itself"): in the
// directions that are hidden a vertex gets what the triangle there reflects, by Lambert's law with its diffuse albedo, one
// value a triangle. Planes, spheres and inner sides of meshes reflect nothing onto others.
#pragma once
#include <optional>
#include <vector>

#include "methods/fogshop/surface_pass.h"

namespace airlight::fogshop {

// Vertices of all meshes that are taken on; above it a scene is refused.
inline constexpr double most_transfer_vertices = 1e6;
double mesh_vertices(const scene::Scene&);

// The Lambertian part of a material; 0 for a table.
Rgb diffuse_albedo(const scene::Material&);

class RadianceTransfer {
 public:
  // `order` bands; `rays` directions per vertex, a fixed spiral of equal areas. Surfaces farther than `reach` [m]
  // neither occlude nor reflect (infinite: all surfaces count). Light is reflected between surfaces `bounces` times.
  // Results do not depend on the number of threads.
  RadianceTransfer(const scene::Scene&, int order, int rays, double reach, int bounces, const scene::Execution&);

  // order^2 coefficients of the visibility (1 open, 0 hidden). Empty where there are none: on spheres and planes, and
  // on the inner side of a mesh.
  std::vector<double> visibility(const scene::Scene&, const SurfacePoint&) const;

  // Irradiance that other surfaces reflect, for light of 1 in each of order^2 harmonics. Empty where there is none.
  std::vector<Rgb> reflected(const scene::Scene&, const SurfacePoint&) const;

  // By surface, order^2 for every vertex; none for other shapes than meshes.
  const std::vector<std::vector<float>>& coefficients() const { return coefficients_; }
  // Coefficients of the light that surfaces reflect, by surface: order^2 for every channel of every vertex; none without bounces.
  const std::vector<std::vector<float>>& reflections() const { return reflections_; }
  double rays_cast() const { return rays_cast_; }

 private:
  struct Corners {
    std::array<std::size_t, 3> vertex;
    std::array<double, 3> weight;
  };
  std::optional<Corners> corners(const scene::Scene&, const SurfacePoint&) const;
  struct Seen {  // from a vertex, in a direction at an angle from its normal
    int surface, triangle;
    float cosine;
  };
  std::vector<std::vector<Seen>> look_around(const scene::Scene&, const std::vector<Vec3>& directions, double reach,
                                             const scene::Execution&);
  void reflect(const scene::Scene&, const std::vector<std::vector<Seen>>&, double solid_angle, const scene::Execution&);
  std::vector<std::vector<Rgb>> sent_by_triangles(const scene::Scene&, std::size_t surface) const;

  int order_;
  double rays_cast_ = 0;
  std::vector<std::vector<float>> coefficients_, reflections_;
};

}  // namespace airlight::fogshop
