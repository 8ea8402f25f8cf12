// How far a picture of the device is from that of the CPU.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene/film.h"

namespace airlight::gpu::test {

// 99th percentile of |b - a| / (a + 1 % of the greatest a); infinite if anything is not finite.
inline double p99(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  const std::vector<float>&x = a.layer(layer), &y = b.layer(layer);
  const double most = *std::max_element(x.begin(), x.end());
  std::vector<double> errors;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) return infinity;
    errors.push_back(std::abs(double(y[i]) - x[i]) / (x[i] + 0.01 * most + 1e-300));
  }
  std::sort(errors.begin(), errors.end());
  return errors[std::size_t(0.99 * double(errors.size() - 1))];
}

}  // namespace airlight::gpu::test
