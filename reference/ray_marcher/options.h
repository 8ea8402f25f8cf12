// Settings of the ray marcher.
#pragma once
#include <string>
#include <vector>

#include "reference/light_map/options.h"
#include "scene/base/settings.h"
#include "scene/scene.h"

namespace airlight::ray_marcher {

// Where the optical depth between a step and a light comes from: steps along a shadow ray, the media's own integrals, or
// a map of the light that is made once (reference/light_map).
enum class Shadow { march, exact, map };

struct Options {
  int steps = 64;          // per camera ray, over the parts of it that lie in media
  int shadow_steps = 32;   // per shadow ray and medium
  double step = 0;         // > 0: length of a camera ray's step instead of a count; unit below
  double shadow_step = 0;  // > 0: length of a shadow ray's step instead of a count
  bool graded = true;      // grade the steps around lights and along unbounded media
  Shadow shadow = Shadow::march;
  light_map::Options map;
  bool simd = true;
  bool skip_empty = true;
  int environment_directions = 256;
  double early_exit = 0;  // stop where every channel's transmittance is below this
  double horizon = 16;    // optical depth at which an infinite ray ends
};

// The optical depth that no step exceeds where light is seen (depth.h): on camera rays, on shadow rays. A hundredth
// more than its share, which equal steps of endless fog have exactly: rounding is not to decide about those.
inline double deepest_step(const Options& o) { return o.step > 0 ? 0.25 : 1.01 * o.horizon / o.steps; }
inline double deepest_shadow_step(const Options& o) {
  return o.shadow_step > 0 ? 0.5 : 1.01 * o.horizon / o.shadow_steps;
}

// Expected relative L2 error of the airlight with 64 and 32 steps, the defaults. 0.015; 0.04 where a
// medium is so thick that steps may be divided (depth.h); 0.08 where surfaces cast shadows, because
// shadow edges fall within steps; the square of a step's depth / 20 where a lamp lies deeper than 35 in
// endless fog. Tests check the bound with scenes of each kind.
double stated_error(const scene::Scene&);

std::vector<scene::SettingSpec> option_specs();

// Lengths `step` and `shadow_step` are given in voxels of the finest grid; `unit` is that voxel's size [m], or 1.
Options read_options(const scene::Settings&, double unit);

}  // namespace airlight::ray_marcher
