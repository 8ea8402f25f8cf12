// Variant `paper` as a picture: systems for the light, one image of coefficients on the faces that the camera sees (eq. 24).
#pragma once
#include "methods/legendre_fluids/paper_light.h"
#include "scene/renderer.h"

namespace airlight::legendre_fluids {

// Why the paper's systems cannot do that scene; one line each.
std::vector<std::string> reasons_against_paper(const scene::Scene&, const PaperOptions&);

std::unique_ptr<scene::Prepared> prepare_paper(std::shared_ptr<const scene::Scene>, const PaperOptions&,
                                               const std::string& settings);

}  // namespace airlight::legendre_fluids
