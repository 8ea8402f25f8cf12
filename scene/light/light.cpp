#include "scene/light/light.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace airlight::scene {
namespace {

// 1 inside the inner cone, 0 outside the outer one, smoothstep of the cosine between.
double cone_factor(const SpotLight& spot, double cosine) {
  const double inner = std::cos(spot.inner_angle);
  const double outer = std::cos(spot.outer_angle);
  if (cosine >= inner) return 1;
  if (cosine <= outer) return 0;
  const double s = (cosine - outer) / (inner - outer);
  return s * s * (3 - 2 * s);
}

}  // namespace

bool is_delta(const Light& light) {
  return match(
      light, [](const PointLight&) { return true; }, [](const SpotLight&) { return true; },
      [](const DirectionalLight&) { return true; }, [](const EnvironmentLight&) { return false; });
}

std::string light_name(const Light& light) {
  return match(
      light, [](const PointLight&) { return "point"; }, [](const SpotLight&) { return "spot"; },
      [](const DirectionalLight&) { return "directional"; }, [](const EnvironmentLight&) { return "environment"; });
}

Light moved(const Light& light, const Vec3& by) {
  Light result = light;
  if (auto* point = std::get_if<PointLight>(&result)) point->position += by;
  if (auto* spot = std::get_if<SpotLight>(&result)) spot->position += by;
  return result;
}

Light turned(const Light& light, double angle) {
  Light result = light;
  if (auto* environment = std::get_if<EnvironmentLight>(&result))
    environment->to_map = environment->to_map * Eigen::AngleAxisd(-angle, Vec3::UnitY()).toRotationMatrix();
  return result;
}

std::optional<LightBall> ball(const Light& light) {
  using Ball = std::optional<LightBall>;
  return match(
      light,
      [](const PointLight& point) -> Ball {
        return LightBall{point.position, point.radius};
      },
      [](const SpotLight& spot) -> Ball {
        return LightBall{spot.position, spot.radius};
      },
      [](const DirectionalLight&) -> Ball { return std::nullopt; },
      [](const EnvironmentLight&) -> Ball { return std::nullopt; });
}

Rgb intensity_towards(const Light& light, const Vec3& from_light) {
  return match(
      light, [](const PointLight& point) { return point.intensity; },
      [&](const SpotLight& spot) -> Rgb {
        return spot.intensity * cone_factor(spot, std::clamp(spot.axis.dot(from_light), -1.0, 1.0));
      },
      [](const DirectionalLight&) -> Rgb { return Rgb::Zero(); },
      [](const EnvironmentLight&) -> Rgb { return Rgb::Zero(); });
}

Incident incident(const Light& light, const Point3& x) {
  if (const auto* sun = std::get_if<DirectionalLight>(&light)) return {sun->to_light, infinity, sun->irradiance};
  const Vec3 offset = ball(light).value().center - x;
  const double distance = offset.norm();
  if (!(distance > 0)) return {Vec3::UnitY(), 0, Rgb::Constant(infinity)};
  const Vec3 to_light = offset / distance;
  return {to_light, distance, intensity_towards(light, -to_light) / (distance * distance)};
}

}  // namespace airlight::scene
