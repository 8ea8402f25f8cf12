// Constants and layouts shared by host and shaders of this method.
#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::fogshop {

// Storage blocks, AT_... in shaders. gpu/raster has 10 to 12 and 14 (surfaces, the tree), gpu/common 9
// (values of an environment). Blocks that no shader uses together share a
// number. `lights` is a uniform block.
namespace at {
enum Binding {
  gaussians = 0,
  lights = 4,
  light_maps = 5,
  pixels = 6,
  surface = 7,
  depths = 8,
  fog_tables = 13,
  // of rays
  tile_lists = 2,
  distances = 3,
  edges = 9,
  ray_values = 10,
  low_pixels = 10,
  low_distances = 11,
  // of environments
  environment_light = 9,
  psf_bands = 10,
  sky_volume = 7,
  beams = 10,
  open_beams = 11,
  // surfaces.comp
  primitives = 1,
  materials = 2,
  light_places = 3,
  scattered = 8,
  surface_tables = 9,
  transfer = 13,
  light_lists = 15,
  // composition.comp
  airlight_layer = 1,
  transmittance_layer = 2,
  mean_layer = 3,
  seen = 5,
};
}  // namespace at

using Float3 = std::array<float, 3>;

// The layouts of fog.glsl and light.glsl.
struct GaussianData {
  Float3 center;
  float a, half_depth, radius_squared, place, unused;
};
struct LightData {
  Float3 position;
  float map_near;
  Float3 intensity;
  float map_far;
  Float3 axis_x;
  float map_tangent;
  Float3 axis_y;
  int map_offset;
  Float3 axis_z;
  float unused;
};

// Lights fill a uniform block. OpenGL promises 16 KiB for one.
constexpr int most_lights = 16384 / sizeof(LightData);
// Room for a number of lights, in steps, so that most scenes share programs.
constexpr int room_for_lights(std::size_t lights) {
  return std::min(most_lights, std::max(16, (int(lights) + 15) / 16 * 16));
}

// Definitions for average_depth.glsl.
std::map<std::string, std::string> dawson_definitions();

// A program with the bindings defined. Throws Error if the driver lays out the structures above otherwise than the
// compiler of the host.
Program& program(Context&, const std::string& file, std::map<std::string, std::string> definitions);

}  // namespace airlight::gpu::fogshop
