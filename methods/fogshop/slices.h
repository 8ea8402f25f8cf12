// Variant S-K, not in the paper: the ray is cut into K slices; the optical depth is exact at their edges, and inside a
// slice the airlight is integrated in closed form with the depth, and 1/distance^2 in the angle, taken as linear. The
// error falls as K^-2 for any number of Gaussians and any optical depth; extrapolated from K/2 and K slices, which
// share their edges and so all depths, as K^-4.
#pragma once
#include <array>
#include <vector>

#include "methods/fogshop/homogeneous_airlight.h"
#include "methods/fogshop/kernels.h"

namespace airlight::fogshop {

// Values at the edges of K slices: arrays of K + 1 values with room as slice_room says.
struct SliceEdges {
  const double* t;  // [m]
  // Depths [-], at extinction ratio 1, from the camera and from the light, the medium's constant included.
  const double* view_depth;
  const double* light_depth;
  // Scattering of the medium up to the edge, per channel [-], at extinction ratio 1; null: it equals the
  // extinction, view_depth.
  const double* const* scattering;
};
// Values that arrays over the edges hold: whole vectors are read beyond the last.
constexpr std::size_t slice_room(int slices) {
  constexpr int padding = GaussianArrays::padding;
  return std::size_t(slices + padding) / padding * padding + 2 * padding;
}

// Working memory of one thread.
struct SliceScratch {
  std::vector<double> weighted_angle, depth;
  std::array<std::vector<double>, 3> transmittance;
};

// Adds to `all`, per channel, the airlight of the slices from one light of 1 W/sr and albedo 1; to `pairs`, unless it
// is null, that of half as many slices between every other edge: the same placement with K/2 slices, K even, from which
// ray_airlight.cpp extrapolates: (4 L_K - L_K/2) / 3. Three
// channels if `coloured`, else the first only. source_radius softens 1/d^2 [m]. g: of the phase function, whose mean over
// the angle of a slice is taken by Boole's rule.
void sum_slices(const SliceEdges&, int slices, const LightFromRay&, double source_radius, double g,
                const Rgb& extinction_ratio, bool coloured, SliceScratch&, Rgb& all, Rgb* pairs);

}  // namespace airlight::fogshop
