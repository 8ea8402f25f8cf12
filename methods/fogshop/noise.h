// Section 5.5 of Zhou et al. 2007: irregular fog without more Gaussians. For each Gaussian that a view ray crosses, the
// ray is bent by a noise that is fixed in the world, and the Gaussian's depth is taken along the bent ray.
#pragma once
#include <array>
#include <cstdint>

#include "methods/fogshop/kernels.h"

namespace airlight::fogshop {

// Gradient noise (Perlin) of three independent channels, tileable: it repeats every 32 cells along each axis.
class Noise {
 public:
  // `scale` [-] > 0: how far a ray may be bent, in radii of the Gaussian; `frequency` in cells per metre; `phase` in
  // cells, added along all axes: animate it. The lattice of gradients follows from the seed.
  Noise(double scale, double frequency, std::uint32_t seed, double phase);

  static constexpr int period = 32;  // cells

  // In [-1, 1]^3, continuous with its first two derivatives, 0 at the lattice's points.
  Vec3 at(const Point3& x) const;

  // The direction in which a ray from `view` along `direction` sees a Gaussian of culling radius r_i = `radius` around
  // `center`; b_i^r = `nearest` is the noise's place. r' = r + n scale r_i/|v - b_i|, the last at most 1: inside.
  Vec3 bent(const Point3& view, const Vec3& direction, const Point3& center, double radius,
            const Point3& nearest) const;

  double scale() const { return scale_; }
  double frequency() const { return frequency_; }
  double phase() const { return phase_; }
  const std::array<int, 256>& permutation() const { return permutation_; }

 private:
  double scale_, frequency_, phase_;
  std::array<int, 256> permutation_;  // of 0 to 255
};

// With noise the arrays' radii are longer than r_i by this factor, so that rays that are bent into a Gaussian meet it
// first; a noise of more than 1 across the ray, which hardly occurs, may still be cut.
inline double noise_reach(double scale) { return 1 + scale; }

// Variant S: replaces the depths A_i of crossings by those of the bent rays, A_i exp(-(e' - e)), and leaves their place
// along the ray, so that depths still grow along it.
void bend(const GaussianArrays&, const Line&, const Noise&, Crossings&);

// Variant paper: y' = T_i(v, p) along the bent rays over the unchanged d_r [-], put in place of Crossings::whole. Never
// negative.
void bent_depths(const GaussianArrays&, const Line&, const Noise&, Erf, Crossings&);

}  // namespace airlight::fogshop
