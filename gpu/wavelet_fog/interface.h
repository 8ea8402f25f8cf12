// Constants and layouts shared by host and shaders of this method: shaders get the numbers as definitions.
#pragma once
#include <map>
#include <string>

#include "gpu/context.h"
#include "gpu/program.h"

namespace airlight::gpu::wavelet_fog {

// Storage blocks, AT_... in shaders. gpu/raster has 10 to 12 and 14 (surfaces, the tree), environments 9. Blocks that
// no shader uses together share a number: no stage needs more than 8.
namespace at {
enum Binding {
  fog = 0,
  grids = 1,
  values = 2,
  emptiness = 3,
  table = 4,
  distances = 5,
  depths = 6,
  counters = 7,
  lit = 8,
  airlight = 6,  // sun.comp
  sun_rays = 8,
  // pack.comp
  packed_values = 4,
  packed_emptiness = 5,
  // surfaces.comp, background.comp
  primitives = 0,
  materials = 1,
  tables = 2,
  // composition.comp
  transmittance_layer = 0,
  ambient_layer = 1,
  surface_layer = 2,
  mean_layer = 3,
  airlight_layer = 4,
  seen = 5,
};
}  // namespace at

enum class RegionKind { unbounded, box, sphere, slab };
enum class Profile { none, layers, exponential };

// The layouts of fog.glsl, without the knots, of grids.glsl, lit.glsl, sun_ray.glsl.
struct FogData {
  double map_x0, map_z0, cos_over_cell, sin_over_cell;
  double region_lo[3], region_hi[3];
  double lowest, highest, mu;
  float sigma_t[3], enough, allowed, scale_height;
  int region, knots, levels, details, cells, errors;
  int map, degree, profile, first_knot, first_word, unused;
};
struct GridData {
  int lo[2], size[2], offset, stride;
};
struct LitData {
  float reflected[4], sum[4];
  double t, unused;
};
// State of a ray under a sun, without the shadow edges that it stores.
struct SunState {
  double end, from, known, cell, before, low, high, way;
  float light[3], depth[3];
  int shadow_ray, flags, halvings, index, edges, read, shadow_rays, unused;
};
// Low and high words of cells and coefficients, whether loops were cut, low and high words of points under a sun and of lookups, whether
// rays under a sun are unfinished, low and high words of their shadow rays.
constexpr int counter_words = 12;

using Definitions = std::map<std::string, std::string>;

// "float[](NAME)" of a list: digits that single precision tells apart.
std::string listed(const std::vector<double>&);

// A program of this folder: `file` without folder and .comp, the definitions, a work group of x times y invocations. Looked up
// by its text, so it is kept by those who need it in every frame. Throws Error if the driver lays out the structures
// above otherwise than the compiler of the host.
Program& program(Context&, const std::string& file, int x, int y = 1, Definitions definitions = {});

}  // namespace airlight::gpu::wavelet_fog
