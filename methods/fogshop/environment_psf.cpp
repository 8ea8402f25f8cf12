#include "methods/fogshop/environment_psf.h"

#include <algorithm>
#include <cmath>

#include "methods/fogshop/surface_psf.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/types.h"

namespace airlight::fogshop {
namespace {

double coefficient(Psf psf, int l, double T) {
  return psf == Psf::ball ? ball_psf_coefficient(l, T) : npsf_coefficient(l, psf == Psf::npsf ? 1 : T);
}

}  // namespace

double ball_psf(double gamma, double T) {
  // t = T sin x takes the root's end into a cosine; for a thick ball most comes from t < 1: x = pi/2 y^2.
  static const scene::GaussLegendre rule = scene::gauss_legendre(64);
  const double cosine = std::cos(gamma), sine = std::sin(gamma);
  double sum = 0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double y = 0.5 * (1 + rule.node[i]), x = 0.5 * pi * y * y;
    const double tau = std::sin(x), s = std::sqrt(1 - tau * tau * sine * sine) - tau * cosine;
    sum += 0.5 * rule.weight[i] * pi * y * std::cos(x) * std::exp(T * (1 - tau - s));
  }
  return sum / (4 * pi);
}

double ball_psf_coefficient(int l, double T) {
  // The root leaves a kink at gamma = pi/2. Towards gamma = 0 a thick ball's light falls as e^(-T gamma^2 ...).
  static const scene::GaussLegendre rule = scene::gauss_legendre(48);
  double sum = 0;
  for (int half = 0; half < 2; ++half)
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double gamma = 0.25 * pi * (1 + rule.node[i]) + 0.5 * pi * half;
      sum += 0.25 * pi * rule.weight[i] * ball_psf(gamma, T) * std::legendre(unsigned(l), std::cos(gamma)) *
             std::sin(gamma);
    }
  return 2 * pi * std::sqrt((2 * l + 1) / (4 * pi)) * sum;
}

PsfBands::PsfBands(Psf psf, int order) : order_(order) {
  const int count = psf == Psf::npsf ? 1 : entries;
  for (int k = 0; k < count; ++k)
    for (int l = 0; l < order; ++l)
      values_.push_back(
          coefficient(psf, l, least_depth * std::pow(greatest_depth / least_depth, double(k) / (entries - 1))));
}

std::vector<double> PsfBands::operator()(double T) const {
  if (depths() == 1) return values_;
  const double place = std::clamp(std::log(T / least_depth) / std::log(greatest_depth / least_depth), 0.0, 1.0);
  const int k = std::min(entries - 2, int(place * (entries - 1)));
  const double s = place * (entries - 1) - k;
  std::vector<double> g(order_);
  const double *low = &values_[k * order_], *high = low + order_;
  for (int l = 0; l < order_; ++l) g[l] = low[l] + s * (high[l] - low[l]);
  return g;
}

}  // namespace airlight::fogshop
