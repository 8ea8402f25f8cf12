// Variant `paper` as a picture: systems for the light, one image of coefficients on the faces that the camera sees (eq. 24).
#pragma once
#include "methods/legendre_fluids/paper_light.h"
#include "scene/renderer.h"

namespace airlight::legendre_fluids {

// Why the paper's systems cannot do that scene; one line each.
std::vector<std::string> unsupported_paper(const scene::Scene&, const PaperOptions&);

// Along which axes the scene's lights or its camera's view move.
std::array<bool, 3> moving_axes(const scene::Scene&);

// Throws Error for a view that is not orthographic, or along an axis that does not move.
void require_view(const scene::View&, const std::array<bool, 3>& moving);

std::unique_ptr<scene::Prepared> prepare_paper(std::shared_ptr<const scene::Scene>, const PaperOptions&,
                                               const std::string& settings);

}  // namespace airlight::legendre_fluids
