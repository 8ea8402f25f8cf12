// Integrals of an environment over the sphere: power, projection on spherical harmonics, negative share.
#include <algorithm>
#include <cmath>

#include "scene/light/environment.h"
#include "scene/light/lat_long.h"
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

// Adds weight * value * Y to the coefficients.
struct Projector {
  int order;
  std::vector<double> basis;
  std::vector<Rgb> sum;
  explicit Projector(int n) : order(n), basis(std::size_t(n) * n), sum(std::size_t(n) * n, Rgb::Zero()) {}
  void add(const Vec3& direction, const Rgb& weighted) {
    if ((weighted == 0).all()) return;
    evaluate_sh(order, direction, basis.data());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += basis[i] * weighted;
  }
};

// Between texel centres the map is bilinear and the rest smooth: two Gauss points per stretch, relative error below
// (order * angle)^4 / 4320. A coarse map has wide stretches and gets more.
void project_map(const EnvironmentLight& light, Projector& projector) {
  const EnvironmentMap& map = *light.map;
  const auto points = [&](double angle) { return std::min(2 + int(3 * projector.order * angle), 64); };
  const GaussLegendre across = gauss_legendre(points(2 * pi / map.width));
  const GaussLegendre down = gauss_legendre(points(pi / map.height));
  for (int strip = 0; strip <= map.height; ++strip) {
    const double begin = strip_begin(strip, map.height), end = strip_begin(strip + 1, map.height);
    const int top = std::max(strip - 1, 0), bottom = std::min(strip, map.height - 1);
    for (std::size_t j = 0; j < down.node.size(); ++j) {
      const double y = 0.5 * (1 + down.node[j]), theta = begin + (end - begin) * y;
      const double cosine = std::cos(theta), sine = std::sin(theta);
      const double weight = down.weight[j] * 0.5 * (end - begin) * sine * pi / map.width;
      for (int left = 0; left < map.width; ++left) {
        const int right = left + 1 == map.width ? 0 : left + 1;
        const Rgb a = (1 - y) * texel(map, left, top) + y * texel(map, left, bottom);
        const Rgb b = (1 - y) * texel(map, right, top) + y * texel(map, right, bottom);
        for (std::size_t i = 0; i < across.node.size(); ++i) {
          const double x = 0.5 * (1 + across.node[i]);
          const Vec3 w = from_lat_long((left + 0.5 + x) / map.width, cosine, sine);
          projector.add(light.to_map.transpose() * w, weight * across.weight[i] * ((1 - x) * a + x * b));
        }
      }
    }
  }
}

}  // namespace

std::vector<Rgb> project_environment(const EnvironmentLight& light, int order) {
  Projector projector(order);
  if (light.map) {
    project_map(light, projector);
    for (Rgb& c : projector.sum) c *= light.scale;
  } else if (light.sh.empty()) {
    projector.sum[0] = std::sqrt(4 * pi) * light.scale;
  } else if (light.to_map == Mat3::Identity()) {
    for (std::size_t i = 0; i < std::min(projector.sum.size(), light.sh.size()); ++i)
      projector.sum[i] = light.scale * light.sh[i];
  } else {
    for_each_sphere_node((order + order_of(light)) / 2 + 1,
                         [&](const Vec3& w, double weight) { projector.add(w, weight * radiance(light, w)); });
  }
  return projector.sum;
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
