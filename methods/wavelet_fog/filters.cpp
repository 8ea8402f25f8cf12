#include "methods/wavelet_fog/filters.h"

#include <fmt/format.h>

#include "scene/base/error.h"
#include "scene/math/bspline.h"

namespace airlight::wavelet_fog {
namespace {

Taps scaled(int first, double by, std::vector<double> values) {
  for (double& value : values) value *= by;
  return {first, std::move(values)};
}

double binomial(int n, int k) {
  double product = 1;
  for (int i = 1; i <= k; ++i) product = product * (n - k + i) / i;
  return product;
}

}  // namespace

const Family& family(const std::string& name) {
  static const std::vector<Family> all = {
      {"haar", 0, {0, {1, 1}}, {0, {1, -1}}, {0, {0.5, 0.5}}, {0, {0.5, -0.5}}},
      {"cdf22", 1, scaled(0, 0.5, {1, 2, 1}), scaled(-2, 0.125, {-1, -2, 6, -2, -1}),
       scaled(-1, 0.125, {-1, 2, 6, 2, -1}), scaled(-1, 0.5, {-1, 2, -1})},
      {"cdf33", 2, scaled(0, 0.25, {1, 3, 3, 1}), scaled(-2, 1.0 / 64, {3, 9, -7, -45, 45, 7, -9, -3}),
       scaled(-2, 1.0 / 64, {3, -9, -7, 45, 45, -7, -9, 3}), scaled(0, 0.25, {1, -3, 3, -1})},
      {"cdf31", 2, scaled(0, 0.25, {1, 3, 3, 1}), scaled(0, 0.25, {-1, -3, 3, 1}), scaled(0, 0.25, {-1, 3, 3, -1}),
       scaled(0, 0.25, {1, -3, 3, -1})},
  };
  for (const Family& f : all)
    if (f.name == name) return f;
  throw Error(fmt::format("family = \"{}\", expected haar, cdf22, cdf33 or cdf31", name));
}

Taps two_scale(int degree) {
  Taps taps;
  for (int k = 0; k <= degree + 1; ++k) taps.values.push_back(binomial(degree + 1, k) / double(1 << degree));
  return taps;
}

Taps semi_orthogonal(int degree) {
  Taps taps;
  for (int k = 0; k <= 3 * degree + 1; ++k) {
    double sum = 0;
    for (int l = 0; l <= degree + 1; ++l)
      sum += binomial(degree + 1, l) * scene::bspline_at_integer(2 * degree + 1, k + 1 - l);
    taps.values.push_back((k % 2 == 0 ? 1 : -1) * sum / double(1 << degree));
  }
  return taps;
}

Taps restriction(int degree) { return scaled(0, 0.5, two_scale(degree).values); }

}  // namespace airlight::wavelet_fog
