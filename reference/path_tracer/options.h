// Settings of the path tracer, parsed once. The names are those of `--set name=value`.
#pragma once
#include <cstdint>
#include <vector>

#include "scene/base/settings.h"

namespace airlight::path_tracer {

struct Options {
  std::uint64_t samples = 256;  // per pixel
  std::uint32_t seed = 1;
  std::uint32_t stream = 0;          // 0 reference, 1 test, 2.. independent repeats
  bool box_pixels = false;           // mean over the pixel instead of the ray through its centre
  int orders = 4;                    // order.0 .. order.K are layers of their own
  int max_order = -1;                // medium scatterings at most; -1: no cap
  int max_events = -1;               // scatterings and reflections together at most; -1: no cap
  double target_error = 0;           // stop by error at n = 2^k; 0: fixed number of samples
  int roulette_order = 5;            // Russian roulette from this many scatterings and reflections on
  double roulette_cap = 1;           // greatest survival probability
  bool supergrid = true;             // local majorants; false: one for the whole medium
  int supergrid_cells = 0;           // per axis; 0: 16, or one cell per 4^3 voxels of a grid
  double majorant_scale = 1;         // multiplies every majorant; below 1 injects a fault
  bool column_transmittance = true;  // noise-free; false: ratio tracking
  bool forced = true;                // collisions are forced where they are rare; see forcing.h
  enum class Connection { automatic, always, never } connection = Connection::automatic;
  // Which paths count. all: every path. lit_surface: paths from the light to a surface to the eye, scattered at most
  // once on the way to the surface and not behind it. scattered_to_surface: the scattered ones of these. scattered:
  // paths whose last event before the eye is in a medium.
  enum class Paths { all, lit_surface, scattered_to_surface, scattered } paths = Paths::all;
  bool only_lit_surfaces() const { return paths == Paths::lit_surface || paths == Paths::scattered_to_surface; }
};

std::vector<scene::SettingSpec> setting_specs();
Options parse_options(const scene::Settings&);

}  // namespace airlight::path_tracer
