#include "methods/fogshop/harmonic_reflection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::fogshop {
namespace {

constexpr int most_bands = 12;

// What each band of the radiance gives to the irradiance: 2 pi integral of x P_l(x) over [0, 1]. Odd bands but the
// first give nothing.
std::array<double, most_bands> cosine_bands() {
  std::array<double, most_bands> bands{};
  bands[0] = pi;
  bands[1] = 2 * pi / 3;
  double term = -1;  // (-1)^(l/2 - 1) l! / (2^l (l/2)!^2), for l = 0
  for (int l = 2; l < most_bands; l += 2) {
    term *= -double(l - 1) / l;
    bands[l] = 2 * pi * term / ((l + 2.0) * (l - 1.0));
  }
  return bands;
}

// Irradiance [W/m^2].
Rgb irradiance(const Vec3& normal, const std::vector<Rgb>& incident, int order) {
  static const std::array<double, most_bands> bands = cosine_bands();
  double y[most_bands * most_bands];
  scene::evaluate_sh(order, normal, y);
  Rgb sum = Rgb::Zero();
  for (int l = 0; l < order; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum += incident[i] * (bands[l] * y[i]);
  return sum;
}

// Integral of (n+2)/(2 pi) x^n * cosine * radiance around the mirrored view, x the cosine from there.
Rgb lobe(double exponent, const Vec3& normal, const Vec3& to_view, const std::vector<Rgb>& incident, int order) {
  const Vec3 axis = 2 * normal.dot(to_view) * normal - to_view;
  const Vec3 a = axis.unitOrthogonal(), b = axis.cross(a);
  static const scene::GaussLegendre rule = scene::gauss_legendre(12);
  constexpr int around = 32;
  double y[most_bands * most_bands];
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    // u = x^(n+1) makes the lobe's weight constant.
    const double u = 0.5 * (1 + rule.node[i]), x = std::pow(u, 1 / (exponent + 1)), s = std::sqrt((1 - x) * (1 + x));
    const double weight = (exponent + 2) / (2 * pi) * 0.5 * rule.weight[i] / (exponent + 1) * 2 * pi / around;
    for (int k = 0; k < around; ++k) {
      const double phi = 2 * pi * (k + 0.5) / around;
      const Vec3 in = x * axis + s * (std::cos(phi) * a + std::sin(phi) * b);
      const double cosine = normal.dot(in);
      if (!(cosine > 0)) continue;
      scene::evaluate_sh(order, in, y);
      Rgb radiance = Rgb::Zero();
      for (int j = 0; j < order * order; ++j) radiance += incident[j] * y[j];
      sum += weight * cosine * radiance;
    }
  }
  return sum;
}

}  // namespace

Rgb reflect_harmonics(const scene::Material& material, const Vec3& normal, const Vec3& to_view,
                      const std::vector<Rgb>& incident) {
  if (!(normal.dot(to_view) > 0)) return Rgb::Zero();
  const int order = int(std::lround(std::sqrt(double(incident.size()))));
  const Rgb diffuse = irradiance(normal, incident, order) / pi;
  if (const auto* lambert = std::get_if<scene::Lambert>(&material)) return lambert->albedo * diffuse;
  const auto& phong = std::get<scene::Phong>(material);
  if (phong.exponent == 0) return (phong.diffuse + phong.specular) * diffuse;  // the whole hemisphere alike
  return phong.diffuse * diffuse + phong.specular * lobe(phong.exponent, normal, to_view, incident, order);
}

}  // namespace airlight::fogshop
