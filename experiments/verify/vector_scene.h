// Scenes from the inputs of vectors.
#pragma once
#include "experiments/verify/entry.h"
#include "scene/scene.h"

namespace airlight::experiments::verification {

// "iso", "isotropic", "ray", "rayleigh", "hg" with g, "hazy", "murky"; complains at `name` otherwise.
scene::PhaseFunction phase_from(const Value& name, double g);

// {type: point, pos, I} or {type: directional, to_light, E}, grey.
scene::Light light_from(const Value&);

// Ray with a direction to be normalised.
Ray ray_from(const Value& origin, const Value& direction);

// One homogeneous medium of extinction sigma_t [1/m] in a region.
scene::Medium fog(const scene::Region&, double sigma_t, double albedo, const scene::PhaseFunction&);

// A Gaussian sum: extinction = b0 + sum c exp(-a^2 |x - b|^2).
struct RawGaussian {
  double a, c;
  Point3 b;
};
scene::Medium gaussian_fog(const std::vector<RawGaussian>&, double b0, double albedo, const scene::PhaseFunction&);
std::vector<RawGaussian> gaussians_from_objects(const Value&);  // [{a, c, b}]
std::vector<RawGaussian> gaussians_from_rows(const Value&);     // [[c, a, [b]]]

}  // namespace airlight::experiments::verification
