// The plain path: one ray at a time, in double, for any medium. It is what the vector kernels are checked against.
//
// Single scattering, (m, s) = (1, 0), with the midpoint rule: in step i of length h, at its midpoint x, with extinction
// k and in-scattered radiance S per unit length, both taken as constant over the step,
//   L += T_i * S * (1 - exp(-k h)) / k,    T_(i+1) = T_i * exp(-k h),
//   S = sum over lights and media of scattering(x) * phase * irradiance(x) * exp(-optical depth to the light).
#pragma once
#include "reference/ray_marcher/plan.h"
#include "scene/picture.h"

namespace airlight::ray_marcher {

using scene::Pixel;

// The media between 0 and t_end alone: airlight and transmittance.
Pixel march_media(const Plan&, const Ray&, double t_end, Counters&);

// The whole ray: media, and what is behind them.
Pixel march_ray(const Plan&, const Ray&, Counters&);

// Light that reaches a surface point directly and leaves it towards -direction [W/m^2/sr], media included.
Rgb lit_surface(const Plan&, const scene::Hit&, const Vec3& direction, Counters&);

// exp(-optical depth) from x to a light of the plan, 0 behind a surface.
Rgb transmittance_to_light(const Plan&, std::size_t light, const Point3& x, const scene::Incident&, Counters&);

}  // namespace airlight::ray_marcher
