// Integrals of an environment over the sphere: power, projection on spherical harmonics, negative share.
#include <algorithm>
#include <cmath>

#include "scene/light/environment.h"
#include "scene/light/lat_long.h"
#include "scene/light/map_projection.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::scene {
namespace {

int order_of(const EnvironmentLight& light) { return int(std::lround(std::sqrt(double(light.sh.size())))); }

Rgb texel(const EnvironmentMap& map, int column, int row) {
  const float* t = &map.rgb[3 * (std::size_t(row) * map.width + column)];
  return {t[0], t[1], t[2]};
}

// Product rule over the sphere, exact for spherical harmonics of total band below 2 n: f(direction, weight).
template <class F>
void for_each_sphere_node(int n, F f) {
  const GaussLegendre rule = gauss_legendre(n);
  for (int j = 0; j < n; ++j) {
    const double sine = std::sqrt((1 - rule.node[j]) * (1 + rule.node[j]));
    for (int i = 0; i < 2 * n; ++i) f(from_lat_long((i + 0.5) / (2 * n), rule.node[j], sine), rule.weight[j] * pi / n);
  }
}

}  // namespace

std::vector<Rgb> project_environment(const EnvironmentLight& light, int order) {
  std::vector<Rgb> sum(std::size_t(order) * std::size_t(order), Rgb::Zero());
  if (light.map) {
    EnvironmentLight smooth = map_about_pole(*light.map, order);
    smooth.to_map = smooth.to_map * light.to_map;
    smooth.scale = light.scale;
    return project_environment(smooth, order);
  }
  if (light.sh.empty()) {
    sum[0] = std::sqrt(4 * pi) * light.scale;
  } else if (light.to_map == Mat3::Identity()) {
    for (std::size_t i = 0; i < std::min(sum.size(), light.sh.size()); ++i) sum[i] = light.scale * light.sh[i];
  } else {
    std::vector<double> basis(sum.size());
    for_each_sphere_node((order + order_of(light)) / 2 + 1, [&](const Vec3& w, double weight) {
      evaluate_sh(order, w, basis.data());
      const Rgb weighted = weight * radiance(light, w);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += basis[i] * weighted;
    });
  }
  return sum;
}

double environment_power(const EnvironmentLight& light) {
  if (light.map) {
    const EnvironmentMap& map = *light.map;
    Rgb sum = Rgb::Zero();
    for (int strip = 0; strip <= map.height; ++strip) {
      // Integrals over the strip of (1 - y) sin(theta) and y sin(theta), y the fraction of the angle.
      const double begin = strip_begin(strip, map.height), end = strip_begin(strip + 1, map.height);
      const double slope = (std::sin(end) - std::sin(begin)) / (end - begin);
      const double above = std::cos(begin) - slope, below = slope - std::cos(end);
      for (int i = 0; i < map.width; ++i)
        sum += above * texel(map, i, std::max(strip - 1, 0)) + below * texel(map, i, std::min(strip, map.height - 1));
    }
    return luminance(light.scale * sum) * 2 * pi / map.width;
  }
  if (!light.sh.empty()) return luminance(light.scale * light.sh[0]) * std::sqrt(4 * pi);
  return luminance(light.scale) * 4 * pi;
}

double negative_fraction(const EnvironmentLight& light) {
  if (light.sh.empty()) return 0;
  double negative = 0;
  for_each_sphere_node(256, [&](const Vec3& w, double weight) {
    if ((radiance(light, w) < 0).any()) negative += weight;
  });
  return negative / (4 * pi);
}

}  // namespace airlight::scene
