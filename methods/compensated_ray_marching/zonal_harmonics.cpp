#include "methods/compensated_ray_marching/zonal_harmonics.h"

#include <cmath>

#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

// Calls of(l, index) for every coefficient of some bands.
template <class Of>
void each_coefficient(int order, const Of& of) {
  for (int l = 0; l < order; ++l)
    for (int m = -l; m <= l; ++m) of(l, std::size_t(scene::sh_index(l, m)));
}

double band_factor(int l) { return std::sqrt(4 * pi / (2 * l + 1)); }

}  // namespace

std::vector<double> about_axis(const std::vector<double>& zonal, const Vec3& axis) {
  std::vector<double> f = scene::evaluate_sh(int(zonal.size()), axis);
  each_coefficient(int(zonal.size()), [&](int l, std::size_t i) { f[i] *= band_factor(l) * zonal[std::size_t(l)]; });
  return f;
}

std::vector<double> convolved(const std::vector<double>& f, const std::vector<double>& zonal) {
  std::vector<double> result = f;
  each_coefficient(int(zonal.size()),
                   [&](int l, std::size_t i) { result[i] *= band_factor(l) * zonal[std::size_t(l)]; });
  return result;
}

std::vector<double> henyey_greenstein(int order, double g) {
  std::vector<double> zonal;
  double power = 1;
  for (int l = 0; l < order; ++l, power *= g) zonal.push_back(std::sqrt(4 * pi * (2 * l + 1)) * power);
  return zonal;
}

// All but Henyey-Greenstein's are polynomials, of degree 32 at most.
std::vector<double> phase_moments(const scene::PhaseFunction& phase, int order) {
  static const scene::GaussLegendre rule = scene::gauss_legendre(64);
  std::vector<double> moments(std::size_t(order), 0.0);
  if (const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase)) {
    for (int l = 0; l < order; ++l) moments[std::size_t(l)] = std::pow(hg->g, l);
    return moments;
  }
  for (std::size_t i = 0; i < rule.node.size(); ++i)
    for (int l = 0; l < order; ++l)
      moments[std::size_t(l)] +=
          2 * pi * rule.weight[i] * phase_value(phase, rule.node[i]) * std::legendre(unsigned(l), rule.node[i]);
  return moments;
}

std::vector<double> turned_back(std::vector<double> f) {
  each_coefficient(int(std::lround(std::sqrt(double(f.size())))), [&](int l, std::size_t i) {
    if (l % 2) f[i] = -f[i];
  });
  return f;
}

}  // namespace airlight::compensated_ray_marching
