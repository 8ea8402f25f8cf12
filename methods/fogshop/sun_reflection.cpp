#include "methods/fogshop/sun_reflection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/fogshop/surface_psf.h"
#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::fogshop {
namespace {

constexpr int rings = 192;

// gamma = pi x^4: the NPSF's 1/gamma is cancelled by the area, and what thick media crowd near 0 is spread.
struct Rings {
  std::vector<double> gamma, weight;  // weight: dgamma
  Rings() {
    const scene::GaussLegendre rule = scene::gauss_legendre(rings);
    for (int i = 0; i < rings; ++i) {
      const double x = 0.5 * (1 + rule.node[i]), x3 = x * x * x;
      gamma.push_back(pi * x3 * x);
      weight.push_back(0.5 * rule.weight[i] * 4 * pi * x3);
    }
  }
};
const Rings& ring_rule() {
  static const Rings rule;
  return rule;
}

double depth_of(int k) {
  using Table = DepthAngleTable;
  return Table::least_depth * std::pow(Table::greatest_depth / Table::least_depth, double(k) / (Table::depths - 1));
}

// Mean of max(0, cos) over a ring: cos = a + b cos phi.
double mean_clamped_cosine(double angle, double gamma) {
  const double a = std::cos(angle) * std::cos(gamma), b = std::sin(angle) * std::sin(gamma);
  if (a >= b) return a;
  if (a <= -b) return 0;
  return (a * std::acos(-a / b) + std::sqrt((b - a) * (b + a))) / pi;
}

// Mean over a ring of lobe * component of the direction, along the lobe's axis or across it.
double mean_lobe(double exponent, bool across, double angle, double gamma) {
  constexpr int around = 128;
  const double ca = std::cos(angle), sa = std::sin(angle), cg = std::cos(gamma), sg = std::sin(gamma);
  double sum = 0;
  for (int k = 0; k < around; ++k) {
    const double c = std::cos(pi * (k + 0.5) / around);
    const double axial = ca * cg - sa * sg * c;
    if (!(axial > 0)) continue;
    sum += std::pow(axial, exponent) * (across ? sa * cg + ca * sg * c : axial);
  }
  return sum / around;
}

}  // namespace

template <class Kernel>
DepthAngleTable::DepthAngleTable(const Kernel& kernel) {
  std::vector<std::vector<double>> means(angles, std::vector<double>(rings));
  for (int a = 0; a < angles; ++a)
    for (int i = 0; i < rings; ++i) means[a][i] = kernel(pi * a / (angles - 1), ring_rule().gamma[i]);
  fill(means);
}

void DepthAngleTable::fill(const std::vector<std::vector<double>>& kernel) {
  const Rings& rule = ring_rule();
  for (int k = 0; k < depths; ++k) {
    std::vector<double> weight(rings);
    for (int i = 0; i < rings; ++i)
      weight[i] = 2 * pi * std::sin(rule.gamma[i]) * npsf(rule.gamma[i], depth_of(k)) * rule.weight[i];
    for (int a = 0; a < angles; ++a) {
      double sum = 0;
      for (int i = 0; i < rings; ++i) sum += weight[i] * kernel[a][i];
      values_.push_back(sum);
    }
  }
}

double DepthAngleTable::operator()(double T, double cosine) const {
  // Below the first depth the function changes by less than 1 %, and the light is T times it.
  const double x = std::clamp(std::log(T / least_depth) / std::log(greatest_depth / least_depth), 0.0, 1.0);
  const int k = std::min(depths - 2, int(x * (depths - 1)));
  const double s = x * (depths - 1) - k;
  const double y = std::acos(std::clamp(cosine, -1.0, 1.0)) / pi * (angles - 1);
  const int a = std::min(angles - 2, int(y));
  const double t = y - a;
  const double* row = &values_[std::size_t(k) * angles + a];
  return (1 - s) * ((1 - t) * row[0] + t * row[1]) + s * ((1 - t) * row[angles] + t * row[angles + 1]);
}

SunReflection::Lobe SunReflection::make_lobe(double exponent) {
  return {exponent, DepthAngleTable([&](double a, double g) { return mean_lobe(exponent, false, a, g); }),
          DepthAngleTable([&](double a, double g) { return mean_lobe(exponent, true, a, g); })};
}

SunReflection::SunReflection(const std::vector<scene::Surface>& surfaces) : lambert_(mean_clamped_cosine) {
  for (const scene::Surface& surface : surfaces) {
    if (std::holds_alternative<scene::Lambert>(surface.material)) continue;
    const auto* phong = std::get_if<scene::Phong>(&surface.material);
    if (!phong)
      throw Error(fmt::format("surface '{}': the form of Sun et al. knows Lambert and Phong alone", surface.name));
    // Exponent 0 is a Lambert surface; no table where nothing shines.
    if (!(phong->exponent > 0) || !(phong->specular > 0).any()) continue;
    if (std::none_of(lobes_.begin(), lobes_.end(), [&](const Lobe& l) { return l.exponent == phong->exponent; }))
      lobes_.push_back(make_lobe(phong->exponent));
  }
}

Rgb SunReflection::reflect(const scene::Material& material, const Vec3& normal, const Vec3& to_view,
                           const Vec3& to_light, double T) const {
  if (!(normal.dot(to_view) > 0)) return Rgb::Zero();
  const double diffuse = lambert_(T, normal.dot(to_light)) / pi;
  if (const auto* lambert = std::get_if<scene::Lambert>(&material)) return lambert->albedo * diffuse;
  const auto& phong = std::get<scene::Phong>(material);
  for (const Lobe& lobe : lobes_) {
    if (lobe.exponent != phong.exponent) continue;
    const Vec3 mirror = 2 * normal.dot(to_view) * normal - to_view;
    const double cosine = mirror.dot(to_light);
    const Vec3 aside = to_light - cosine * mirror;
    const double length = aside.norm();
    double sum = lobe.along(T, cosine) * normal.dot(mirror);
    if (length > 1e-12) sum += lobe.across(T, cosine) * normal.dot(aside) / length;  // 0 where light and mirror agree
    return phong.diffuse * diffuse + phong.specular * ((phong.exponent + 2) / (2 * pi) * std::max(0.0, sum));
  }
  return (phong.diffuse + (phong.exponent > 0 ? Rgb(Rgb::Zero()) : phong.specular)) * diffuse;
}

}  // namespace airlight::fogshop
