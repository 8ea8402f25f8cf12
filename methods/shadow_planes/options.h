// Settings of the method.
#pragma once
#include <string>
#include <vector>

#include "scene/base/settings.h"
#include "scene/scene.h"

namespace airlight::shadow_planes {

struct Options {
  // Evaluator of the airlight of a lit part of a ray: the mapped rule, or the paper's polynomial.
  enum class Evaluator { rule, polynomial };
  Evaluator evaluator = Evaluator::rule;
  int nodes = 64;      // of the rule
  int stretch = 6;     // m of its map
  int degree = 4;      // of the polynomial
  bool annex = false;  // the printed coefficients
  // How lit parts come about: by counting surfaces; each plane adding or subtracting (wrong where shadows overlap); the
  // paper's planes, back to front by the middles of their edges, with a stencil (wrong where that is not their order).
  enum class Shadows { none, counted, signed_sum, stencil };
  Shadows shadows = Shadows::counted;
  int edge_split = 1;  // pieces of every edge, for the order and the mesh
  // Where the airlight of a lit ray is computed: for every pixel, or at vertices of surfaces, planes and media, with
  // linear interpolation over triangles.
  enum class Evaluation { pixels, vertices };
  Evaluation evaluation = Evaluation::pixels;
  int plane_levels = 16;    // strips of a plane away from the light, before the one that is endless
  int boundary_cells = 16;  // along each side of the six faces that a medium's boundary is cut into
  // Media with regions: with their own ways of light, or as the paper has it.
  enum class Bounded { exact, paper };
  Bounded bounded = Bounded::exact;
  bool frame_buffer = false;    // sums are rounded to 8 bits and clamped to 1 after each plane
  bool printed_phases = false;  // hazy and murky with means 2 and 83/33
  bool ambient = false;         // the scene's ambient_in_scatter
};
std::vector<scene::SettingSpec> setting_specs(const Options& defaults = {});
Options read_options(const scene::Settings&);
// For `explain`: how many edges of how many lights, and when they are found.
std::string silhouettes_found(std::size_t edges, std::size_t lights);
// Why the method cannot render the scene with these settings, a line each; empty: it can.
std::vector<std::string> unsupported(const scene::Scene&, const Options&);

// Extinction [1/m] of a medium that `unsupported` accepts, which is therefore homogeneous.
Rgb extinction_of(const scene::Medium&);
// Whether both sets of accepted media scatter equally in the same regions.
bool same_media(const std::vector<scene::Medium>&, const std::vector<scene::Medium>&);

}  // namespace airlight::shadow_planes
