// Settings of the method.
#pragma once
#include <vector>

#include "scene/settings.h"

namespace airlight::shadow_planes {

struct Options {
  // What integrates the airlight of a lit part of a ray: the mapped rule, or the paper's polynomial.
  enum class Evaluator { rule, polynomial };
  Evaluator evaluator = Evaluator::rule;
  int nodes = 64;        // of the rule
  int stretch = 6;       // m of its map
  int degree = 4;        // of the polynomial
  bool centred = false;  // expanded about the middle of the lit part, not about theta = 0
  bool annex = false;    // the printed coefficients
  // How lit parts come about: by counting surfaces; each plane adding or subtracting (wrong where shadows overlap); the
  // paper's planes, back to front by the middles of their edges, with a stencil (wrong where that is not their order).
  enum class Shadows { none, counted, signed_sum, stencil };
  Shadows shadows = Shadows::counted;
  int edge_split = 1;           // pieces of every edge, for the order
  bool frame_buffer = false;    // sums are rounded to 8 bits and clamped to 1 after each plane
  bool printed_phases = false;  // hazy and murky with means 2 and 83/33
  bool ambient = false;         // the scene's ambient_in_scatter
  bool moving_lights = false;   // silhouettes are found for every picture, not once
};
std::vector<scene::SettingSpec> setting_specs();
Options read_options(const scene::Settings&);

}  // namespace airlight::shadow_planes
