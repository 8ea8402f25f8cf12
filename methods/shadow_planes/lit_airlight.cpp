#include "methods/shadow_planes/lit_airlight.h"

#include <algorithm>
#include <cmath>

#include "methods/shadow_planes/polynomial.h"
#include "methods/shadow_planes/rule_sum.h"

namespace airlight::shadow_planes {

void cross_cone(const LightFromRay& light, const Vec3& direction, const Vec3& axis, double angle,
                std::vector<double>& places) {
  // cos(theta) n.A + sin(theta) w.A = cos(angle).
  const double n = light.n.dot(axis), w = direction.dot(axis), length = std::hypot(n, w), cosine = std::cos(angle);
  if (!(std::abs(cosine) <= length)) return;
  const double middle = std::atan2(w, n), half = std::acos(cosine / length);
  for (double theta : {middle - half, middle + half}) {
    theta = std::remainder(theta, 2 * pi);
    if (std::abs(theta) < 0.5 * pi) places.push_back(light.T + light.h * std::tan(theta));
  }
}

LitAirlight::LitAirlight(const std::vector<scene::Medium>& media, const Options& options)
    : options_(options),
      alone_(media.size() == 1 && std::holds_alternative<scene::Unbounded>(media.front().region)),
      bounded_(media, options.printed_phases),
      rule_(options.nodes, options.stretch),
      bounded_rule_(options.nodes, options.stretch, true) {
  if (!alone_) return;
  const scene::Medium& medium = media.front();
  phase_ = phase_form(medium.phase, options.printed_phases);
  extinction_ = extinction_of(medium);
  albedo_ = medium.albedo;
}

Rgb LitAirlight::operator()(const scene::Light& light, const Ray& ray, Interval lit) const {
  const Point3 at = scene::ball(light)->center;
  if (std::holds_alternative<scene::PointLight>(light)) return part(light, at, ray, lit);
  const auto& spot = std::get<scene::SpotLight>(light);
  const LightFromRay from = light_from_ray(ray, at);
  std::vector<double> places{lit.lo};
  for (const double angle : {spot.inner_angle, spot.outer_angle})
    cross_cone(from, ray.direction, spot.axis, angle, places);
  places.erase(std::remove_if(places.begin() + 1, places.end(), [&](double x) { return !(x > lit.lo && x < lit.hi); }),
               places.end());
  std::sort(places.begin(), places.end());
  places.push_back(lit.hi);
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 0; k + 1 < places.size(); ++k)
    if (places[k + 1] > places[k]) sum += part(light, at, ray, {places[k], places[k + 1]});
  return sum;
}

Rgb LitAirlight::part(const scene::Light& light, const Point3& at, const Ray& ray, Interval lit) const {
  const auto* spot = std::get_if<scene::SpotLight>(&light);
  const Rgb light_intensity = spot ? spot->intensity : std::get<scene::PointLight>(light).intensity;
  scene::Light white = scene::PointLight{at, Rgb::Ones(), 0};
  if (spot) white = scene::SpotLight{at, spot->axis, spot->inner_angle, spot->outer_angle, Rgb::Ones(), 0};
  const auto towards = [&](const Vec3& d) { return intensity_towards(white, d)[0]; };
  const LightFromRay from = light_from_ray(ray, at);
  if (spot) {
    // Nothing of it where it is dark.
    const double x = std::isfinite(lit.hi) ? 0.5 * (lit.lo + lit.hi) : std::max(lit.lo, from.T) + 1 + from.h;
    if (towards((ray.at(x) - at).normalized()) == 0) return Rgb::Zero();
  }
  if (!alone_) return light_intensity * bounded_.airlight(bounded_rule_, ray, at, lit, towards);
  Rgb result = Rgb::Zero();
  for (int c = 0; c < 3; ++c) {
    const double k = extinction_[c];
    if (!(k > 0)) continue;
    if (c > 0 && k == extinction_[c - 1]) {
      result[c] = albedo_[c - 1] > 0 ? result[c - 1] / albedo_[c - 1] * albedo_[c] : 0;
      if (albedo_[c - 1] > 0) continue;
    }
    double shape;
    if (options_.evaluator == Options::Evaluator::polynomial) {
      shape = polynomial(k, from, lit);
    } else {
      const LitPart<double> part{lit.lo, lit.hi - lit.lo};
      const double integral = spot ? airlight_integral(rule_, phase_, k, from.T, from.h, part,
                                                       [&](double q, double v, double w) {
                                                         return towards(2 * q * v * from.n + (w - v) * ray.direction);
                                                       })
                                   : isotropic_integral(rule_, phase_, k, from.T, from.h, part);
      shape = k / (4 * pi) * std::exp(-k * (lit.lo + std::hypot(lit.lo - from.T, from.h))) * integral;
    }
    result[c] = albedo_[c] * shape;
  }
  return light_intensity * result;
}

double LitAirlight::polynomial(double extinction, const LightFromRay& light, Interval lit) const {
  if (!(light.h > 0)) return 0;
  const double begin = std::atan2(lit.lo - light.T, light.h);
  const double end = std::isfinite(lit.hi) ? std::atan2(lit.hi - light.T, light.h) : 0.5 * pi;
  const double a = extinction * light.h;
  const std::vector<double> c =
      options_.annex ? printed_coefficients(phase_, a) : taylor_coefficients(phase_, a, options_.degree);
  return polynomial_airlight(c, 0, extinction, 1, 1, light.T, light.h, begin, end);
}

}  // namespace airlight::shadow_planes
