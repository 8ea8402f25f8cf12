// Constants and layouts shared by host and shaders of the renderer.
#pragma once
#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::compensated_ray_marching {

// Storage blocks, AT_... in shaders. Blocks that no shader uses together share a number; 9 is that of environments.
namespace at {
enum Binding {
  // sources
  columns = 0,
  powers = 1,
  harmonics = 2,
  nodes = 3,
  single = 4,
  result = 5,
  source = 6,
  state = 7,
  open = 4,
  found_columns = 1,
  hidden_nodes = 2,
  node_of_cell = 3,
  emitted = 1,
  light = 0,
  ways = 3,
  densities = 2,
  weighted = 2,
  steps = 3,
  means = 1,
  parts = 3,
  towards_light = 2,
  radiance = 6,
  greatest = 7,
  logarithms = 5,
  balance = 8,
  edges = 0,
  edge_nodes = 1,
  edge_weights = 2,
  volume = 5,
  // camera rays
  density = 0,
  ranges = 1,
  airlight_layer = 2,
  transmittance_layer = 3,
  surface_layer = 4,
  ambient_layer = 5,
  mean_layer = 6,
  column = 7,
  distances = 3,
  primitives = 5,
  lit = 1,
  seen = 0,
  // centres of Gaussians
  centre_tables = 0,
  centres = 2,
  spheres = 3,
  passed = 4,
  single_bands = 5,
  light_bands = 6,
  terms = 7,
  again = 3,
  centre_sources = 4,
  matrix = 6,
  row_scales = 7,
  vectors = 0,
  systems = 1,
  // maps of environments
  map_texels = 0,
  circle = 1,
  fourier = 2,
  row_weights = 3,
  projected = 4,
};
}  // namespace at

constexpr int kept = 5;  // iterations that are combined: methods/compensated_ray_marching/discrete_ordinates.cpp

using Definitions = std::map<std::string, std::string>;

// A program of this folder: `file` without folder and .comp, a work group of x times y invocations.
Program& program(Context&, const std::string& file, int x, int y, Definitions definitions);

}  // namespace airlight::gpu::compensated_ray_marching
