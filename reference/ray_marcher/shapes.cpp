#include "reference/ray_marcher/shapes.h"

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::ray_marcher {

PhaseShape phase_shape(const scene::PhaseFunction& phase) {
  const auto shape = [](PhaseShape::Kind kind, double g = 0) {
    PhaseShape shape;
    shape.kind = kind;
    shape.g = float(g);
    return shape;
  };
  return scene::match(
      phase, [&](scene::Isotropic) { return shape(PhaseShape::isotropic); },
      [&](scene::Rayleigh) { return shape(PhaseShape::rayleigh); },
      [&](scene::HenyeyGreenstein hg) { return shape(PhaseShape::henyey_greenstein, hg.g); },
      [&](scene::Hazy) { return shape(PhaseShape::hazy); }, [&](scene::Murky) { return shape(PhaseShape::murky); });
}

LightShape light_shape(const scene::Light& light) {
  LightShape shape;
  const auto put = [](const Vec3& v, double* to) { std::copy(v.data(), v.data() + 3, to); };
  scene::match(
      light,
      [&](const scene::PointLight& point) {
        shape.kind = LightShape::point;
        put(point.position, shape.position);
      },
      [&](const scene::SpotLight& spot) {
        shape.kind = LightShape::spot;
        put(spot.position, shape.position);
        put(spot.axis, shape.axis);
        shape.cos_inner = std::cos(spot.inner_angle);
        shape.cos_outer = std::cos(spot.outer_angle);
      },
      [&](const scene::DirectionalLight& sun) { put(sun.to_light, shape.axis); },
      [](const scene::EnvironmentLight&) { throw Error("ray_marcher: an environment has many directions"); });
  return shape;
}

Rgb light_colour(const scene::Light& light) {
  return scene::match(
      light, [](const scene::PointLight& point) { return point.intensity; },
      [](const scene::SpotLight& spot) { return spot.intensity; },
      [](const scene::DirectionalLight& sun) { return sun.irradiance; },
      [](const scene::EnvironmentLight&) -> Rgb { throw Error("ray_marcher: an environment has many directions"); });
}

}  // namespace airlight::ray_marcher
