#include "methods/compensated_ray_marching/incoming_light.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {

namespace {

bool directional_alone(const std::vector<scene::Light>& lights) {
  bool any = false;
  for (const scene::Light& light : lights) {
    if (std::holds_alternative<scene::EnvironmentLight>(light)) return false;
    const auto* sun = std::get_if<scene::DirectionalLight>(&light);
    any = any || (sun && sun->irradiance.maxCoeff() > 0);
  }
  return any;
}

}  // namespace

IncomingLight::IncomingLight(const std::vector<scene::Light>& lights, EnvironmentBands bands)
    : bands_(std::move(bands)) {
  if (!directional_alone(lights)) fixed_ = ordinate_directions(bands_.order(), 2 * bands_.order(), false);
  become(lights);
}

bool IncomingLight::fits(const std::vector<scene::Light>& lights) const {
  return directional_alone(lights) == fixed_.empty();
}

void IncomingLight::become(const std::vector<scene::Light>& lights) {
  directions_.clear();
  for (const Ordinate& d : fixed_) directions_.push_back(d.direction);
  power_.assign(directions_.size(), Rgb::Zero());
  for (const scene::Light& light : lights) {
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) {
      if (!(sun->irradiance.maxCoeff() > 0)) continue;
      directions_.push_back(sun->to_light);
      power_.push_back(sun->irradiance);
    } else if (const auto* environment = std::get_if<scene::EnvironmentLight>(&light)) {
      std::vector<Rgb> harmonics;
      if (environment->map) {
        harmonics = bands_.upright(environment->map);
      } else if (!environment->sh.empty()) {
        harmonics = environment->sh;
        harmonics.resize(std::min(harmonics.size(), std::size_t(bands_.order() * bands_.order())));
      }
      for (std::size_t k = 0; k < fixed_.size(); ++k) {
        const Rgb radiance =
            harmonics.empty() ? Rgb::Ones() : scene::evaluate_sh(harmonics, environment->to_map * fixed_[k].direction);
        power_[k] += fixed_[k].weight * environment->scale * radiance;
      }
    }
  }
}

Rgb IncomingLight::brightest() const {
  if (directions_.size() > fixed_.size()) return Rgb::Constant(std::numeric_limits<double>::max());
  Rgb most = Rgb::Zero();
  for (std::size_t k = 0; k < fixed_.size(); ++k) most = most.max(power_[k] / fixed_[k].weight);
  return most;
}

bool IncomingLight::dark() const {
  return std::all_of(power_.begin(), power_.end(), [](const Rgb& p) { return (p == 0).all(); });
}

bool IncomingLight::grey() const {
  return std::all_of(power_.begin(), power_.end(), [](const Rgb& p) { return p[0] == p[1] && p[1] == p[2]; });
}

}  // namespace airlight::compensated_ray_marching
