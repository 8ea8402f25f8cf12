// Lights, and what reaches a point from each of those that come from one direction.
//
// A light with a radius is an opaque ball without medium: a camera ray that passes closer than the radius ends on it,
// and optical depths to the light are measured from its centre as if the medium continued.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/base/kinds.h"
#include "scene/light/environment.h"
#include "scene/math/types.h"

namespace airlight::scene {

struct PointLight {
  Point3 position = Point3::Zero();
  Rgb intensity = Rgb::Ones();  // [W/sr]
  double radius = 0;            // [m], >= 0
};

// Full intensity inside inner_angle of the axis, none beyond outer_angle, smoothstep of the cosine between; angles from
// the axis [rad], 0 <= inner <= outer <= pi.
struct SpotLight {
  Point3 position = Point3::Zero();
  Vec3 axis = -Vec3::UnitY();  // unit, the direction in which it shines
  double inner_angle = 0.3;
  double outer_angle = 0.4;
  Rgb intensity = Rgb::Ones();  // [W/sr] on the axis
  double radius = 0;
};

struct DirectionalLight {
  Vec3 to_light = Vec3::UnitY();  // unit, from the scene towards the light
  Rgb irradiance = Rgb::Ones();   // [W/m^2] on a plane that faces it
};

using Light = std::variant<PointLight, SpotLight, DirectionalLight, EnvironmentLight>;

// True for lights that illuminate a point from exactly one direction (all but the environment).
bool is_delta(const Light&);
std::string light_name(const Light&);  // "point", "spot", "directional", "environment"
// Why a renderer that knows no other lights than these cannot render that one; empty if it can.
template <class... Known>
std::string unknown_light(const std::vector<Light>& lights, std::size_t i) {
  const std::string other = unknown_kind<Known...>(lights[i], light_name);
  return other.empty() ? "" : fmt::format("light {} is {}", i, other);
}

// Light that a delta light sends to a point in vacuum.
struct Incident {
  Vec3 to_light;    // unit
  double distance;  // [m], infinite for a directional light
  Rgb irradiance;   // [W/m^2] on a plane that faces it: intensity/distance^2, or the directional irradiance
};
// Zero irradiance outside a spot's cone. At the light itself the irradiance is infinite. Requires is_delta.
Incident incident(const Light&, const Point3& x);

// Position and radius of a point or spot light; nothing for the others.
struct LightBall {
  Point3 center;
  double radius;
};
std::optional<LightBall> ball(const Light&);

// A point or spot light somewhere else; the others as they are.
Light moved(const Light&, const Vec3& by);

// An environment turned about the y axis [rad]; the others as they are.
Light turned(const Light&, double angle);

// Intensity of a point or spot light towards a unit direction from it [W/sr].
Rgb intensity_towards(const Light&, const Vec3& from_light);

}  // namespace airlight::scene
