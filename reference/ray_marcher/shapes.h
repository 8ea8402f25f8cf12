// Lights and phase functions of a scene as the kernels know them.
#pragma once
#include "reference/ray_marcher/kernels.h"
#include "scene/light/light.h"
#include "scene/phase.h"

namespace airlight::ray_marcher {

PhaseShape phase_shape(const scene::PhaseFunction&);

// Both for lights that shine from one direction: not an environment.
LightShape light_shape(const scene::Light&);
Rgb light_colour(const scene::Light&);  // irradiance [W/m^2] of a directional light, else intensity on the axis [W/sr]

}  // namespace airlight::ray_marcher
