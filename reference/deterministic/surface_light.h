// What a camera ray sees at its end, through the medium: surfaces lit by delta lights, order (0, 1), and the
// background, order (0, 0). Light that surfaces get from an environment or from each other is left out: it is no finite
// sum.
#pragma once
#include "reference/deterministic/airlight.h"

namespace airlight::deterministic {

// Radiance leaving the end of the ray towards its origin, before the view path's transmittance [W/m^2/sr]. Zero on a
// light's ball.
Rgb end_radiance(const scene::Scene&, const AirlightIntegrator&, const Ray&, const scene::RayEnd&);

}  // namespace airlight::deterministic
