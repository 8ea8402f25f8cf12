#include "methods/compensated_ray_marching/gaussian_depth.h"

#include <algorithm>
#include <cmath>

#include "scene/math/gauss_legendre.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double root_pi_half = 0.88622692545275801365;  // sqrt(pi) / 2
constexpr double nothing_beyond = 7;                     // widths: what lies there is below rounding

}  // namespace

double gaussian_depth(double distance, double mu, double cut) {
  const double along = distance * mu, aside = std::max(0.0, distance * distance * (1 - mu) * (1 + mu));
  if (cut == infinity) return root_pi_half * std::exp(-aside) * (1 + std::erf(along));
  if (!(aside < cut * cut)) return 0;
  const double half = std::sqrt(cut * cut - aside);
  return root_pi_half * std::exp(-aside) * (std::erf(half) - std::erf(std::clamp(-along, -half, half)));
}

// From outside, the angle is that under which a point of the equator at sin(phi) cuts is seen: the depth is smooth in phi. From inside,
// points gather at a right angle, where the way through the Gaussian is shortest and, close to its cut, bends sharply.
std::vector<double> zonal_depth(int order, double distance, double cut) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(96);
  std::vector<double> depth(std::size_t(order), 0.0);
  const auto add = [&](double theta, double weight) {
    const double mu = std::cos(theta), value = gaussian_depth(distance, mu, cut) * std::sin(theta) * weight;
    for (int l = 0; l < order; ++l) depth[std::size_t(l)] += value * std::legendre(unsigned(l), mu);
  };
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double x = 0.5 * (1 + rule.node[i]), weight = 0.25 * pi * rule.weight[i];
    if (distance > cut) {
      const double phi = 0.5 * pi * x, sine = cut * std::sin(phi) / distance;
      add(std::asin(sine), weight * cut * std::cos(phi) / (distance * std::sqrt((1 - sine) * (1 + sine))));
    } else {
      for (const double side : {-1.0, 1.0}) add(0.5 * pi * (1 + side * x * x * x), weight * 3 * x * x);
    }
  }
  for (int l = 0; l < order; ++l) depth[std::size_t(l)] *= 2 * pi * std::sqrt((2 * l + 1) / (4 * pi));
  return depth;
}

double angle_of_distance(double d) { return d >= 1 ? std::asin(1 / d) : pi - std::asin(d); }

double distance_of_angle(double theta) { return theta <= 0.5 * pi ? 1 / std::sin(theta) : std::sin(theta); }

DepthTable::DepthTable(int order, Spacing spacing, int samples, double cut) : order_(order), spacing_(spacing) {
  const double end = std::min(cut, nothing_beyond);
  for (int i = 0; i < samples; ++i) {
    const double share = double(i) / (samples - 1);
    std::vector<double> depth(std::size_t(order), 0.0);
    if (spacing == Spacing::paper) {
      if (i > 0) depth = zonal_depth(order, i == samples - 1 ? 0 : distance_of_angle(share * pi), cut);
    } else if (i < samples - 1) {
      const double d = share / (1 - share);
      depth = zonal_depth(order, d, cut);
      for (double& value : depth) value *= 1 + d * d;
    } else {  // pi^1.5 / d^2 of a direction, but for what the cut takes off
      const double far = 4 * pi * (0.5 * root_pi_half * std::erf(end) - 0.5 * end * std::exp(-end * end));
      for (int l = 0; l < order; ++l) depth[std::size_t(l)] = far * std::sqrt((2 * l + 1) / (4 * pi));
    }
    samples_.insert(samples_.end(), depth.begin(), depth.end());
  }
}

void DepthTable::zonal(double distance, double* depth) const {
  const int last = int(samples_.size()) / order_ - 1;
  const double share = spacing_ == Spacing::paper ? angle_of_distance(distance) / pi : distance / (1 + distance);
  const double place = std::clamp(share, 0.0, 1.0) * last;
  const int i = std::min(int(place), last - 1);
  const double scale = spacing_ == Spacing::paper ? 1 : 1 / (1 + distance * distance);
  for (int l = 0; l < order_; ++l) {
    const double lower = samples_[std::size_t(i * order_ + l)], upper = samples_[std::size_t((i + 1) * order_ + l)];
    depth[l] = scale * (lower + (place - i) * (upper - lower));
  }
}

}  // namespace airlight::compensated_ray_marching
