// How far a picture of the device is from that of the CPU.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/film/film.h"

namespace airlight::gpu::test {

// The value that `share` of |b - a| / (a + 1 % of the greatest a) lie below; infinite if anything is not finite.
inline double quantile(const scene::Film& a, const scene::Film& b, const std::string& layer, double share) {
  const std::vector<float>&x = a.layer(layer), &y = b.layer(layer);
  const double most = *std::max_element(x.begin(), x.end());
  std::vector<double> errors;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) return infinity;
    errors.push_back(std::abs(double(y[i]) - x[i]) / (std::abs(x[i]) + 0.01 * most + 1e-300));
  }
  std::sort(errors.begin(), errors.end());
  return errors[std::size_t(share * double(errors.size() - 1))];
}

inline double p99(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  return quantile(a, b, layer, 0.99);
}

}  // namespace airlight::gpu::test
