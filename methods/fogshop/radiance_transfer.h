// Precomputed radiance transfer of static meshes: which directions other surfaces hide from a point, in spherical
// harmonics. Zhou et al. 2007, V_p of Eq. 20, after Sloan et al. 2002.
//
// Computed at the vertices, interpolated over the triangle of a hit. It shadows scattered light, and all light of
// environments; direct light of points keeps its exact test. Directions that point into the surface at a vertex (below
// the horizon of every face there) count as open: the reflectance is 0 in them, and so a convex mesh shadows itself not
// at all instead of by what harmonics cut off at a band make of its horizon.
#pragma once
#include <vector>

#include "methods/fogshop/surface_pass.h"

namespace airlight::fogshop {

// Vertices of all meshes that are taken on; above it a scene is refused.
inline constexpr double most_transfer_vertices = 1e6;
double mesh_vertices(const scene::Scene&);

class RadianceTransfer {
 public:
  // `order` bands; `rays` directions per vertex, a fixed spiral of equal areas; surfaces farther than `reach` [m] hide
  // nothing (infinite: all do). The same for any number of threads.
  RadianceTransfer(const scene::Scene&, int order, int rays, double reach, const scene::Execution&);

  // order^2 coefficients of the visibility (1 open, 0 hidden). Empty where there are none: on spheres and planes, and
  // on the inner side of a mesh.
  std::vector<double> visibility(const scene::Scene&, const SurfacePoint&) const;

  // By surface, order^2 for every vertex; none for other shapes than meshes.
  const std::vector<std::vector<float>>& coefficients() const { return coefficients_; }
  double rays_cast() const { return rays_cast_; }

 private:
  int order_;
  double rays_cast_ = 0;
  std::vector<std::vector<float>> coefficients_;
};

}  // namespace airlight::fogshop
