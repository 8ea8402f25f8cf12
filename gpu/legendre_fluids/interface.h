// Constants and layouts shared by host and shaders of this method.
#pragma once
#include <fmt/format.h>

#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::legendre_fluids {

// Name of an entry of a uniform array.
inline std::string at_index(const char* name, std::size_t i) { return fmt::format("{}[{}]", name, i); }

// Storage blocks, AT_... in shaders. Blocks that no shader uses together share a number.
namespace at {
enum Binding {
  start = 1,
  state = 2,
  rates = 3,
  pressure = 4,
  spread = 5,
  status = 6,
  gathered = 7,
  regions = 0,
  // light_*.comp
  distances = 0,
  reached = 1,
  columns = 2,
  airlight_layer = 3,
  lit = 4,
  transmittance_layer = 5,
  ambient_layer = 6,
  surface_layer = 7,
  mean_layer = 0,
  stretches = 5,  // light_cut.comp and what follows it
  ways = 6,
  walked = 7,
  shades = 4,
  seen = 1,     // light_composition.comp
  targets = 0,  // light_density.comp
  particles = 4,
  // paper_*.comp
  tables = 0,
  work = 3,
  values = 4,
  direct = 7,
  faces = 2,
  ray_ends = 8,  // paper_image.comp
  kept = 7,      // paper_density.comp
  floats = 5,    // paper_fluid_end.comp
  // uniform blocks
  matrices = 0,
  densities = 0,
  rule = 1,
};
}  // namespace at

// Where expand.comp goes on to, and collect.comp comes from.
enum class GoesOn { nowhere, to_points, to_modes };
enum class ComesFrom { points, modes, forces };

using Definitions = std::map<std::string, std::string>;

// A program of this folder: `file` without folder and .comp, a work group of x times y invocations.
Program& program(Context&, const std::string& file, int x, int y, Definitions definitions);

}  // namespace airlight::gpu::legendre_fluids
