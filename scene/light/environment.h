// Light from infinitely far away, from all directions: a constant, a lat-long map, or spherical harmonics.
//
// Map: +y at the top row, the centre column looks along -z, +x to the right of it; bilinear between texel centres,
// wrapping around in longitude, clamped at the poles. Spherical harmonics: real, orthonormal, Condon-Shortley, index
// l(l+1)+m, polar axis z of the world, of lookup directions (towards the light); they may be negative, and are not
// clamped.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

// Linear RGB radiance on a lat-long grid, row 0 at +y. width = 2 height is usual, not required.
struct EnvironmentMap {
  int width = 0;
  int height = 0;
  std::vector<float> rgb;  // 3 per texel, x fastest; finite, >= 0
};

// A light; immutable after make_environment, which builds the sampling tables. Directions are unit and point towards
// the light.
struct EnvironmentLight {
  Rgb scale = Rgb::Ones();                    // multiplies the map, the coefficients or 1
  Mat3 to_map = Mat3::Identity();             // world direction to map direction (a rotation)
  std::shared_ptr<const EnvironmentMap> map;  // null: no map
  std::vector<Rgb> sh;                        // (order)^2 coefficients; empty: none. With neither: the constant `scale`
  struct Tables;                              // null for a constant, which is sampled uniformly
  std::shared_ptr<const Tables> tables;
  std::string source;  // file, or "constant", or "sh"
};

// All three throw Error if a value is not finite, `to_map` is no rotation, or (constant, map) radiance is negative.
EnvironmentLight make_constant_environment(const Rgb& radiance);
EnvironmentLight make_map_environment(std::shared_ptr<const EnvironmentMap>, const Mat3& to_map, const Rgb& scale,
                                      std::string source);
// `coefficients.size()` must be a square, at most max_sh_order^2. Throws Error otherwise.
EnvironmentLight make_sh_environment(std::vector<Rgb> coefficients, const Mat3& to_map, const Rgb& scale);

// Reads a lat-long RGB map from OpenEXR (any compression) or whatever read_color_image knows; Error on NaN, infinity or a negative
// value (with the pixel). In EXR files, negative values below 1 % of the mean, which lossy compression leaves in the dark, become 0.
std::shared_ptr<const EnvironmentMap> read_environment_map(const std::string& path);

// Radiance from direction w [W/m^2/sr].
Rgb radiance(const EnvironmentLight&, const Vec3& w);

// A direction for two uniforms in [0, 1), and its density over solid angle [1/sr]: 5 % uniform, 95 % proportional to
// the luminance of the map, bilinear as the map itself (lat_long_density.h), or for spherical harmonics to that of the
// absolute radiance on a grid. Positive everywhere; a constant or black environment is sampled uniformly.
Vec3 sample_environment(const EnvironmentLight&, double u1, double u2);
double pdf_environment(const EnvironmentLight&, const Vec3& w);

// Radiance and that density together, for the price of one.
struct EnvironmentValue {
  Rgb radiance;
  double pdf;
};
EnvironmentValue evaluate_environment(const EnvironmentLight&, const Vec3& w);

// Projection on real spherical harmonics of `order` bands (order^2 coefficients) over world directions; relative error
// below 1e-12. For a map, its bilinear interpolation is projected.
std::vector<Rgb> project_environment(const EnvironmentLight&, int order);

// Integral of the luminance over the sphere [W/m^2], exact for the bilinear map.
double environment_power(const EnvironmentLight&);
// Share of the sphere, in [0, 1], where an SH light is negative in at least one channel, to about 1e-3.
double negative_fraction(const EnvironmentLight&);

}  // namespace airlight::scene
