#include "methods/fogshop/harmonic_reflection.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::fogshop {
namespace {

constexpr int greatest_order = 12;

std::vector<Rgb> lambert_harmonics(const Rgb& albedo, const Vec3& normal, int order) {
  static const std::vector<double> cosine = clamped_cosine(greatest_order);
  std::vector<Rgb> result;
  for (const double b : turned_zonal({cosine.begin(), cosine.begin() + order}, normal))
    result.push_back(albedo / pi * b);
  return result;
}

// Rings of the rule over the hemisphere: a lobe cos^n is 1/sqrt(n) wide.
int rings(const scene::Material& material) {
  const auto* phong = std::get_if<scene::Phong>(&material);
  return phong ? std::clamp(int(std::ceil(16 * std::sqrt(phong->exponent / 50))), 16, 256) : 16;
}

}  // namespace

std::vector<double> clamped_cosine(int order) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(16);
  std::vector<double> result(order, 0.0);
  for (int i = 0; i < 16; ++i) {
    const double x = 0.5 * (1 + rule.node[i]);
    const std::vector<double> y = scene::evaluate_sh(order, Vec3(std::sqrt((1 - x) * (1 + x)), 0, x));
    for (int l = 0; l < order; ++l) result[l] += 2 * pi * 0.5 * rule.weight[i] * x * y[scene::sh_index(l, 0)];
  }
  return result;
}

std::vector<double> turned_zonal(const std::vector<double>& bands, const Vec3& axis) {
  const int order = int(bands.size());
  std::vector<double> result = scene::evaluate_sh(order, axis);
  for (int l = 0; l < order; ++l) {
    const double factor = std::sqrt(4 * pi / (2 * l + 1)) * bands[l];
    for (int m = -l; m <= l; ++m) result[scene::sh_index(l, m)] *= factor;
  }
  return result;
}

std::vector<Rgb> reflectance_harmonics(const scene::Material& material, const Vec3& normal, const Vec3& to_view,
                                       int order) {
  if (order < 1 || order > greatest_order)
    throw Error(fmt::format("harmonics of order {}, expected 1 to {}", order, greatest_order));
  std::vector<Rgb> result(order * order, Rgb::Zero());
  if (!(normal.dot(to_view) > 0)) return result;
  if (const auto* lambert = std::get_if<scene::Lambert>(&material))
    return lambert_harmonics(lambert->albedo, normal, order);
  const int count = rings(material), around = 2 * count;
  static const scene::GaussLegendre usual = scene::gauss_legendre(16);
  const scene::GaussLegendre own = count == 16 ? scene::GaussLegendre{} : scene::gauss_legendre(count);
  const scene::GaussLegendre& rule = count == 16 ? usual : own;
  const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a);
  std::vector<double> basis(order * order);
  for (int i = 0; i < count; ++i) {
    const double c = 0.5 * (1 + rule.node[i]), s = std::sqrt((1 - c) * (1 + c));
    for (int k = 0; k < around; ++k) {
      const double phi = 2 * pi * (k + 0.5) / around;
      const Vec3 in = c * normal + s * (std::cos(phi) * a + std::sin(phi) * b);
      const Rgb value = scene::brdf(material, normal, in, to_view) * (c * 0.5 * rule.weight[i] * (2 * pi / around));
      if ((value == 0).all()) continue;
      scene::evaluate_sh(order, in, basis.data());
      for (std::size_t n = 0; n < basis.size(); ++n) result[n] += value * basis[n];
    }
  }
  return result;
}

Rgb reflect_harmonics(const std::vector<Rgb>& reflectance, const std::vector<Rgb>& incident) {
  if (reflectance.size() != incident.size())
    throw Error(fmt::format("a reflectance of {} coefficients for light of {}, expected as many", reflectance.size(),
                            incident.size()));
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < incident.size(); ++i) sum += incident[i] * reflectance[i];
  return sum;
}

Rgb reflect_zonal(const std::vector<Rgb>& reflectance, const std::vector<double>& bands, const Vec3& to_light) {
  const std::vector<double> light = turned_zonal(bands, to_light);
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < light.size(); ++i) sum += light[i] * reflectance[i];
  return sum;
}

}  // namespace airlight::fogshop
