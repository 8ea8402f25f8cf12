#include "methods/shadow_planes/paper_medium.h"

#include <algorithm>
#include <cmath>

#include "methods/shadow_planes/lit_airlight.h"
#include "methods/shadow_planes/polynomial.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::shadow_planes {

double mean_distance(const scene::Region& region) {
  if (const auto* sphere = std::get_if<scene::Sphere>(&region)) return 1.2 * sphere->radius;
  // From a face to all depths below it; beside it, differences of two uniform numbers, 2 (1 - t) on [0, 1].
  const Vec3 size = std::get<Box>(region).size();
  const scene::GaussLegendre rule = scene::gauss_legendre(32);
  double sum = 0, area = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double deep = size[axis], wide = size[(axis + 1) % 3], high = size[(axis + 2) % 3];
    area += wide * high;
    for (std::size_t i = 0; i < rule.node.size(); ++i)
      for (std::size_t j = 0; j < rule.node.size(); ++j)
        for (std::size_t k = 0; k < rule.node.size(); ++k) {
          const double x = 0.5 * (1 + rule.node[i]), y = 0.5 * (1 + rule.node[j]), z = 0.5 * (1 + rule.node[k]);
          sum += wide * high * 0.125 * rule.weight[i] * rule.weight[j] * rule.weight[k] * 4 * (1 - y) * (1 - z) *
                 std::sqrt(deep * deep * x * x + wide * wide * y * y + high * high * z * z);
        }
  }
  return sum / area;
}

PaperMedium::PaperMedium(const scene::Medium& medium, const Options& options)
    : options_(options),
      region_(medium.region),
      extinction_(extinction_of(medium)),
      albedo_(medium.albedo),
      phase_(phase_form(medium.phase, options.printed_phases)),
      R_(mean_distance(medium.region)),
      rule_(options.nodes, options.stretch) {}

Rgb PaperMedium::operator()(const scene::Light& light, const Ray& ray, Interval lit) const {
  const Interval inside = clip(region_, ray, {0, infinity});
  const Interval within = intersect(inside, lit);
  if (within.empty()) return Rgb::Zero();
  const Point3 at = scene::ball(light)->center;
  const LightFromRay from = light_from_ray(ray, at);
  const auto* spot = std::get_if<scene::SpotLight>(&light);
  std::vector<double> places{within.lo, within.hi};
  if (spot)
    for (const double angle : {spot->inner_angle, spot->outer_angle})
      cross_cone(from, ray.direction, spot->axis, angle, places);
  for (double& x : places) x = std::clamp(x, within.lo, within.hi);
  std::sort(places.begin(), places.end());
  const Rgb light_intensity = spot ? spot->intensity : std::get<scene::PointLight>(light).intensity;
  scene::Light white = light;
  if (spot) std::get<scene::SpotLight>(white).intensity.setOnes();
  const auto intensity = [&](double sine, double cosine) {
    return spot ? intensity_towards(white, cosine * from.n + sine * ray.direction)[0] : 1;
  };
  Rgb sum = Rgb::Zero();
  for (int c = 0; c < 3; ++c) {
    const double k = extinction_[c];
    if (!(k > 0)) continue;
    if (c > 0 && k == extinction_[c - 1]) {
      sum[c] = sum[c - 1];
      continue;
    }
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      if (places[i] < places[i + 1]) sum[c] += part(k, from, inside.lo, {places[i], places[i + 1]}, intensity);
  }
  return light_intensity * albedo_ * sum;
}

template <class Intensity>
double PaperMedium::part(double k, const LightFromRay& from, double x_in, Interval lit, Intensity&& intensity) const {
  // x - x_in, the way to the eye, is T - x_in + h tan(theta).
  const double T = from.T, h = std::max(from.h, 1e-120 * std::min(std::abs(lit.lo - T), std::abs(lit.hi - T)));
  if (options_.evaluator == Options::Evaluator::polynomial) {
    const double begin = std::atan2(lit.lo - T, h), end = std::atan2(lit.hi - T, h);
    return k / (4 * pi * h) * std::exp(-k * (T + R_ - x_in)) *
           integrate_polynomial(bounded_coefficients(phase_, k * h, options_.degree), 0, begin, end);
  }
  if (!(h > 0)) return infinity;
  const auto lit_phase = [&](double q, double v, double w) {
    return phase_of_halves(phase_, v, w) * intensity(w - v, 2 * q * v);
  };
  double sum = 0;
  if (lit.lo < T)
    sum = std::exp(-k * (lit.lo - x_in + R_)) * before_foot(k, h, T - lit.lo, std::max(0.0, T - lit.hi), lit_phase);
  // Behind the foot point tan(theta) soon is q/2: the rule for integrands that fall as e^(-extinction h q).
  if (const double begin = std::max(lit.lo, T); begin < lit.hi)
    sum += mapped_integral(rule_, phase_.width(), 0.5 * k, 0.5 * k, T, h, LitPart<double>{begin, lit.hi - begin},
                           [&](double q, double v, double w, double) {
                             const double x = T + 0.5 * h * (q - 1 / q);
                             return std::exp(-k * (x - x_in + R_)) * lit_phase(q, v, w);
                           });
  return k / (4 * pi) * sum;
}

// (1/h) integral over theta from `begin` to `end` [m] before the foot point of e^(-k (begin - d)) lit_phase. With
// d = h sinh(t), q = e^-t and dtheta = dt / cosh(t), in pieces over which neither factor changes by more than e^4 or
// e^8.
template <class LitPhase>
double PaperMedium::before_foot(double k, double h, double begin, double end, LitPhase&& lit_phase) const {
  // Deeper parts of the medium add nothing, even if the light is close to the ray there.
  const double least = std::max(end, begin - (MappedRule<double>::depth_cut + std::log1p(k * begin * begin / h)) / k);
  double sum = 0, depth = 0;  // to where the piece begins
  for (double d = begin; d > least;) {
    const double t = std::asinh(d / h);
    const double next = std::max({least, d - 4 / k, h * std::sinh(t - 8)}), span = t - std::asinh(next / h);
    double piece = 0;
    for (std::size_t i = 0; i < rule_.node.size(); ++i) {
      const double back = span * rule_.node[i], q = std::exp(back - t), v = 1 / (1 + q * q);
      const double way = 2 * h * std::cosh(t - 0.5 * back) * std::sinh(0.5 * back);
      piece += rule_.weight[i] * std::exp(-k * way) * 2 * q * v * lit_phase(q, v, q * q * v);
    }
    sum += std::exp(-depth) * span * piece;
    depth += k * (d - next);
    d = next;
  }
  return sum / h;
}

}  // namespace airlight::shadow_planes
