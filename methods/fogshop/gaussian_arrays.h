// The Gaussians of the medium as the kernels want them: one array per quantity, padded to whole vectors, each Gaussian
// with the radius beyond which it is left out.
#pragma once
#include <array>
#include <vector>

#include "scene/math/types.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::fogshop {

// How far a Gaussian reaches.
enum class Cull {
  // R_i = sqrt(ln(c_i sqrt(pi) / (a_i threshold))) / a_i: no line integral loses more than `threshold` [-] of optical
  // depth; the same at every scale of the scene.
  depth,
  // Zhou et al. 2007, Eq. 30: R_i = sqrt(ln c_i + 9) / a_i, where the density falls to e^-9 per metre. The threshold is
  // a density, not a depth: the loss grows with the scale of the scene.
  paper,
};

// R_i [m], or 0 if the Gaussian is never seen. a = 1/width, c = amplitude in 1/m.
double cull_radius(double a, double c, Cull, double threshold);

struct GaussianArrays {
  // Lanes of the widest vectors; arrays are padded to a multiple with Gaussians that no line meets.
  static constexpr int padding = 8;

  int count = 0;
  std::vector<double> x, y, z;         // centre [m]
  std::vector<double> a;               // 1/width [1/m]
  std::vector<double> half_depth;      // c sqrt(pi) / (2 a) [-]: half the optical depth through the centre
  std::vector<double> radius_squared;  // R_i^2 [m^2], -1 in the padding
  std::vector<int> index;              // place in the arrays that this is a part of; its own place in the whole
  // Fog::colours by channel; empty where all albedos are equal.
  std::array<std::vector<double>, 3> colour;
  bool has_colours() const { return !colour[0].empty(); }

  Point3 center(int i) const { return {x[i], y[i], z[i]}; }
};

// All Gaussians whose radius is not 0; the rest is counted. Under Cull::depth the threshold is taken relative to the
// optical depth of the deepest Gaussian where that is below 1: a thin medium loses no greater share than a thick one.
struct CulledGaussians {
  GaussianArrays arrays;
  int dropped = 0;
  double threshold = 0;  // what it comes to [-]
};
CulledGaussians make_arrays(const std::vector<scene::Gaussian>&, Cull, double threshold,
                            const std::vector<Rgb>& colours = {});

// The Gaussians at these places of `whole`; their `index` points there.
GaussianArrays subset(const GaussianArrays& whole, const std::vector<int>& places);

}  // namespace airlight::fogshop
