// Variant `ray` as a picture: layers, surfaces, counters.
#pragma once
#include "methods/legendre_fluids/light_options.h"
#include "scene/renderer.h"

namespace airlight::legendre_fluids {

std::unique_ptr<scene::Prepared> prepare_rays(std::shared_ptr<const scene::Scene>, const RayOptions&,
                                              const std::string& settings);

}  // namespace airlight::legendre_fluids
