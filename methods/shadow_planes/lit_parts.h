// Pictures from the lit parts of rays: the improved variant, and the sum without a stencil.
#pragma once
#include <optional>

#include "methods/shadow_planes/airlight_term.h"
#include "methods/shadow_planes/edge_fan.h"
#include "methods/shadow_planes/pixel.h"
#include "methods/shadow_planes/shadow_volumes.h"

namespace airlight::shadow_planes {

struct LitLight {
  const std::vector<AirlightTerm>& airlight_terms;
  const scene::Light& light;
  const ShadowVolumes* shadows;  // null: all is lit
  const EdgeFan* fan;            // of their edges
  Options::Shadows how;          // counted, or signed_sum
};

// Adds the light's airlight to pixels of a tile. `count`: m of the camera, of each ray's own origin where there is none.
void add_lit_parts(const LitLight&, std::optional<int> count, std::vector<Pixel>&, Counts&, StageSeconds&);

}  // namespace airlight::shadow_planes
