// The numbers that a scene may hold: chosen so that no product of them that a renderer forms leaves the range of double
// (1e-308 to 1e308), nor the square of one (the moments of Monte Carlo).
//
// Lengths are 1e-9 to 1e9 m, so places are at most 3.5e9 m apart, and
//   (distance/width)^2 of a Gaussian             at most   1.2e37, its fourth power 1e74
//   areas of triangles, their squares             1e-36 to 1e38
//   optical depth = extinction * length           1e-39 to 1e6 Gaussians * 1e11; to the end of a medium
//                                                 without bounds lengths of 1/extinction count, up to 1e30
//   1/d^2 beside a light (d down to 1e-9 m)       1e-19 to 1e18
//   phase function                                4e-8 to 1.6e11 (|g| at most 0.999999)
//   reflectance of a Phong lobe                   at most 1.6e5 (exponent at most 1e6)
//   intensity * extinction * length * phase / d^2 1e-96 to 1e86; its square 1e-192 to 1e172; sums of 1e12 of those.
// An albedo may be any share: it only multiplies, and a picture (32-bit floats) holds nothing below 1e-45.
// Extinction ends where a mean free path drowns in the rounding of places (require_resolved).
// Renderers in single precision also check scene/single_precision.h.
#pragma once
#include "scene/load/values.h"
#include "scene/scene.h"

namespace airlight::scene::load {

class TableReader;

inline constexpr double least_length = 1e-9, greatest_length = 1e9;  // [m]

// Optical depth of a metre at the greatest extinction. A mean free path is then 1e5 times the rounding of coordinates
// at a distance of one metre.
inline constexpr double greatest_depth = 1e11;

inline constexpr Range coordinate =
    either_sign(or_zero({1e-30, greatest_length}));             // [m]; also angles [rad], wave vectors [1/m]
inline constexpr Range length{least_length, greatest_length};   // [m]; factors on lengths
inline constexpr Range length_or_zero = or_zero(length);        // radius of a light, width of a street
inline constexpr Range amount = or_zero({1e-30, 1e30});         // of light, extinction per density
inline constexpr Range density_range = or_zero({1e-20, 1e20});  // amplitudes with either sign
inline constexpr Range signed_amount = either_sign(amount);     // harmonics
inline constexpr Range extinction_range =
    or_zero({1e-30, greatest_depth});                          // [1/m]: per density, times greatest density
inline constexpr Range widths{1e-9, 1e9, false, false, true};  // a distance in widths, may be infinite
inline constexpr Range anisotropy{-0.999999, 0.999999};        // of Henyey and Greenstein
inline constexpr Range field_of_view{1e-6, pi - 1e-6};         // [rad]
inline constexpr Range exponent_range{0, 1e6};                 // of Phong

// Limits that depend on several values of a file. Each function throws Error at the key.

// Extinction per density times the greatest density, or amplitude, or constant.
void require_extinction(const TableReader&, const Medium&);
// The greatest extinction times the largest coordinate of the camera and of what bounds the medium (not its lights):
// at most greatest_depth, for places are rounded to 1e-16 of it.
void require_resolved(const TableReader&, const Scene&, const Medium&);
// The brightest texel of a map, scaled.
void require_radiance(const TableReader&, const EnvironmentLight&);
// Places of a mesh, of the corners of a grid, of a map on the ground.
void require_near(const TableReader&, const std::string& key, const TriangleMesh&);
void require_near(const TableReader&, const std::string& key, const VoxelGrid&);
void require_near(const TableReader&, const std::string& key, const Fogmap&);

}  // namespace airlight::scene::load
