// The vector kernels' plain data and entry points. Float arithmetic, many points or rays at once; each entry picks the
// widest instruction set of the machine at run time (AVX-512, AVX2). Results do not depend on which, nor on how points
// are grouped: every lane is computed alone, in one order of operations.
//
// Arrays hold `n` entries; they must be readable and writable up to `padded(n)`.
#pragma once
#include <cstddef>

#include "reference/ray_marcher/grid_field.h"

namespace airlight::ray_marcher {

constexpr std::size_t padded(std::size_t n) { return (n + 63) / 64 * 64; }

// World points in double, for each its local coordinates in float.
void to_local(const Frame&, std::size_t n, const double* x, const double* y, const double* z, float* lx, float* ly,
              float* lz);
// World directions in float, for each its local vector.
void rotate_to_local(const Frame&, std::size_t n, const float* x, const float* y, const float* z, float* lx, float* ly,
                     float* lz);

// Rays for shadow columns: local origins, local directions per metre, and the range [t0, t1] in metres.
struct LocalRays {
  const float *ox, *oy, *oz;
  const float *dx, *dy, *dz;
  float *t0, *t1;  // empty where t0 >= t1
};

// Intersects the range of each ray with a shape that is simple in its frame: box [-half, half]^3, unit sphere, or
// |x| <= half[0].
struct LocalShape {
  enum Kind { everything, box, sphere, slab } kind = everything;
  float half[3] = {0, 0, 0};
};
void clip_rays(const LocalShape&, std::size_t n, const LocalRays&);

// Intersects with the box [lo, hi].
void clip_rays(const float lo[3], const float hi[3], std::size_t n, const LocalRays&);

// How a range is divided: `count` steps, or as many as needed for steps of `length` metres if that is positive.
struct StepRule {
  int count;
  float length;
};

// Trilinear density at local points.
void grid_density(const GridField&, std::size_t n, const float* x, const float* y, const float* z, float* density);

// column += integral of the density over the ranges, midpoint rule; returns the number of density evaluations.
// With `skip`, steps in empty bricks are passed over.
long long grid_columns(const GridField&, const StepRule&, bool skip, std::size_t n, const LocalRays&, float* column);

// A sum of Gaussians in a local frame; arrays of `count`.
struct GaussianField {
  Frame frame;
  float lo[3], hi[3];  // the support, local
  std::size_t count = 0;
  // reach: distance where it is cut off, or below 1e-14 of its amplitude
  std::vector<float> x, y, z, inverse_width, amplitude, reach;
  float constant = 0;
  bool any_negative = false;  // then the sum is clamped: varied = max(0, constant + sum) - constant
};

// Density without the constant, at local points; neighbours in the arrays should be neighbours in space.
long long gaussian_density(const GaussianField&, std::size_t n, const float* x, const float* y, const float* z,
                           float* density);
long long gaussian_columns(const GaussianField&, const StepRule&, std::size_t n, const LocalRays&, float* column);

// Columns without steps: exact up to rounding, with an absolute error of 2e-7 of each Gaussian's whole
// column. Requires !any_negative.
void gaussian_integrals(const GaussianField&, std::size_t n, const LocalRays&, float* column);

// Weight of a step: exp(-depth before it) * (1 - exp(-depth)) / depth * length.
void step_weights(std::size_t n, const float* before, const float* depth, const float* length, float* weight);

// Steps as seen by a light.
struct LitSteps {
  const double *x, *y, *z;     // midpoints, world
  const double *dx, *dy, *dz;  // direction of the camera ray
  const float* length;         // of the step
};
struct Incidence {
  float *to_x, *to_y, *to_z;  // unit, world, towards the light
  float* distance;            // infinite for a directional light
  float* minus;               // 1 - cosine of the scattering angle
  float* plus;                // 1 + cosine
  float* strength;            // mean over the step of 1/distance^2 (1 for directional), times a spot's falloff
};
struct LightShape {
  enum Kind { directional, point, spot } kind = directional;
  double position[3] = {0, 0, 0};  // of a point or spot light
  double axis[3] = {0, 0, 0};      // to the light (directional), or where a spot shines
  double cos_inner = 1, cos_outer = 0;
};
void incidence(const LightShape&, std::size_t n, const LitSteps&, const Incidence&);

// One layer's part in the light that steps scatter towards the camera.
struct PhaseShape {
  enum Kind { isotropic, rayleigh, henyey_greenstein, hazy, murky } kind = isotropic;
  float g = 0;
};
struct Scatterer {
  PhaseShape phase;
  float sigma_t[3];        // one per channel of the transport
  float colour[3];         // albedo times the light's colour
  const float* amount[3];  // per channel of the transport: weight * sigma_t * density
  const float* column;     // to the light, of this layer's density
};
// sums[c] += colour[c] * amount * phase * strength * exp(-depth[c] - sum of sigma_t * column), over all scatterers. With
// one channel of transport (all sigma_t grey) that channel serves all three colours. `depth`: by channel of the
// transport, an optical depth to the light beside the columns; null: none.
void scatter(const Scatterer* scatterers, std::size_t count, int channels, std::size_t n, const Incidence&,
             const float* const* depth, float* const sums[3]);

}  // namespace airlight::ray_marcher
