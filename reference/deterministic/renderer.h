// Renderer "deterministic": noise-free truth for what has one. Layers: airlight (order (1, 0) from delta lights),
// surface (orders (0, 0) of the background and (0, 1) of delta lights), ambient (scene.ambient_in_scatter), mean (their
// sum), transmittance, error (estimate of the airlight's quadrature error, absolute).
#pragma once
#include "scene/renderer.h"

namespace airlight::deterministic {

std::unique_ptr<scene::Renderer> make_renderer();

// True where point or spot light l sits on `origin` inside a scattering medium: rays from there have no finite
// airlight.
bool light_on_camera(const scene::Scene&, const Point3& origin);

}  // namespace airlight::deterministic
