// Constants and layouts shared by host and shaders of the ray marcher; the structures are in scene_data.h.
#pragma once
#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::ray_marcher {

// Storage blocks, AT_... in shaders. gpu/raster has 10 to 12 and 14 (surfaces, the tree), gpu/common 9
// (values of an environment). Blocks that no shader uses together share a number. `layers` and
// `line_rule` are uniform blocks, beside storage blocks 0 and 1.
namespace at {
enum Binding {
  layers = 0,
  line_rule = 1,   // uniform
  light_maps = 0,  // storage
  gaussians = 1,
  grid_values = 2,
  free_distances = 3,
  lights = 4,
  distances = 5,
  primitives = 5,
  pixels = 6,
  surface = 7,
  materials = 8,
  solids = 9,
  rounds = 13,
  reflectances = 15,
  // composition.comp
  airlight_layer = 0,
  transmittance_layer = 1,
  mean_layer = 2,
  totals = 8,
  seen = 3,
};
}  // namespace at

// A program with the bindings defined. Throws Error if the driver lays out the structures of scene_data.h otherwise than
// the compiler of the host.
Program& program(Context&, const std::string& file, std::map<std::string, std::string> definitions);

}  // namespace airlight::gpu::ray_marcher
