// Constants and layouts shared by host and shaders of this method: shaders get the numbers as definitions.
#pragma once
#include <algorithm>
#include <map>
#include <string>

#include "gpu/context.h"
#include "gpu/program.h"

namespace airlight::gpu::shadow_planes {

// Storage blocks, AT_... in shaders. gpu/raster has 10 to 12 and 14 (surfaces, the tree), gpu/common 2 (materials).
// Blocks that no shader uses together share a number; the largest shader has 12.
namespace at {
enum Binding {
  edges = 0,
  primitives = 1,
  materials = 2,
  lists = 4,
  evaluator = 5,
  pixels = 6,
  states = 7,
  media = 8,
  tables = 9,
  light_state = 13,
  values = 14,
  counters = 15,
  // silhouette.comp, counts.comp
  mesh_vertices = 1,
  mesh_triangles = 2,
  mesh_numbers = 3,
  mesh_edges = 4,
  mesh_sides = 5,
  sectors = 1,  // fan.comp
  // composition.comp
  distances = 1,
  airlight_layer = 0,
  ambient_layer = 2,
  transmittance_layer = 3,
  surface_layer = 4,
  mean_layer = 5,
  // evaluate.comp
  cases = 0,
  integrals = 1,
};
}  // namespace at

// Uniform blocks have numbers of their own: `evaluator`, `media`, and `light_state` where it is only read.

enum class RegionKind { unbounded, box, sphere, slab };
constexpr int edges_per_group = 64;  // of indirect dispatches
constexpr int sectors_per_group = 1024;
constexpr int most_nodes = 1024;  // of the rule: what a uniform block holds on every device
constexpr int most_hits = 16;     // crossings that a pixel gathers at a time: 4 bits number them (crossings.glsl)

// The layouts of edge.glsl, state.glsl, pixels.glsl and media.glsl.
struct alignas(16) EdgeData {
  float near_a[4], near_b[3];
  int multiplicity;
  double a[3], b[3];
  int origin, left_out;
};
struct alignas(16) StateData {
  double last_key, from;
  float sum[4];
  int last_origin, m, unfinished, m_origin;
};
struct LitPixelData {
  float airlight[4], reflected[4];
};
struct alignas(32) MediumData {
  double lo[4], hi[4];
  float extinction[4], albedo[4];
  int phase;
  float g, scale, width;
  int region;
};

// Media fill a uniform block. OpenGL promises 16 KiB for one.
constexpr int most_media = 16384 / sizeof(MediumData);
static_assert(most_media <= 128, "airlight.glsl has 128 bits");
// Room for a number of media, in steps, so that most scenes share programs.
constexpr int room_for_media(std::size_t media) { return std::max(32, (int(media) + 31) / 32 * 32); }

// Layout of light_state.glsl.
struct LightStateData {
  int edge_count, count_at_camera;
  unsigned edge_groups[3], plane_groups[3];
};

// Layout of counters.glsl, with the first entry of resume_groups.
struct CountersData {
  unsigned lit_parts, crossings, gatherings_after_first, loops_were_cut, values_missing, unused[3], unfinished[4];
};

// All of the above, the fan's and phase functions' numbers (methods/shadow_planes/edge_fan.h, phase_form.h).
std::map<std::string, std::string> shared_definitions();

// A program of this folder: `file` without folder and .comp, the definitions, a work group of x times y invocations. Looked up
// by its text, so it is kept by those who need it in every frame. Throws Error if the driver lays out the structures
// above otherwise than the compiler of the host.
Program& program(Context&, const std::string& file, int x, int y = 1,
                 std::map<std::string, std::string> definitions = {});

}  // namespace airlight::gpu::shadow_planes
