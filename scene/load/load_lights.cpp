#include <fmt/format.h>

#include "scene/load/parts.h"
#include "scene/load/ranges.h"

namespace airlight::scene::load {
namespace {

PointLight read_point(TableReader reader) {
  reader.allow({"type", "position", "intensity", "radius"});
  return {reader.vector("position"), reader.color("intensity", amount), reader.number("radius", length_or_zero, 0)};
}

SpotLight read_spot(TableReader reader) {
  reader.allow({"type", "position", "axis", "target", "inner_angle", "outer_angle", "intensity", "radius"});
  SpotLight spot;
  spot.position = reader.vector("position");
  if (reader.one_of({"axis", "target"}) == "axis") {
    spot.axis = reader.direction("axis");
  } else {
    const Vec3 view = reader.vector("target") - spot.position;
    const double distance = view.stableNorm();
    if (!(distance >= least_length))
      reader.expected("target", fmt::format("a point {} m or more from the light's position", least_length));
    spot.axis = (view / distance).normalized();
  }
  const Range angle{0, pi};
  spot.outer_angle = reader.number("outer_angle", angle);
  spot.inner_angle = reader.number("inner_angle", angle, spot.outer_angle);
  if (spot.inner_angle > spot.outer_angle)
    reader.expected("inner_angle", fmt::format("at most outer_angle = {}", spot.outer_angle));
  spot.intensity = reader.color("intensity", amount);
  spot.radius = reader.number("radius", length_or_zero, 0);
  return spot;
}

DirectionalLight read_directional(TableReader reader) {
  reader.allow({"type", "to_light", "irradiance"});
  return {reader.direction("to_light"), reader.color("irradiance", amount)};
}

}  // namespace

Light read_light(TableReader reader, const std::string& folder) {
  return match(
      read_kind(reader, light_name), [&](const PointLight&) -> Light { return read_point(reader); },
      [&](const SpotLight&) -> Light { return read_spot(reader); },
      [&](const DirectionalLight&) -> Light { return read_directional(reader); },
      [&](const EnvironmentLight&) -> Light { return read_environment(reader, folder); });
}

}  // namespace airlight::scene::load
