// How far a picture of the device is from that of the CPU.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "experiments/device/film_difference.h"
#include "scene/film/film.h"
#include "tests/gpu/device.h"

namespace airlight::gpu::test {

// The value that `share` of |b - a| / (a + 1 % of the greatest a) lie below; infinite if anything is not finite.
inline double quantile(const scene::Film& a, const scene::Film& b, const std::string& layer, double share) {
  return experiments::difference_quantile(a, b, layer, share);
}

inline double p99(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  return quantile(a, b, layer, 0.99);
}

struct Bounds {
  double p99, worst = infinity;
};

// Checks layers, by default all: the 99th percentile and the worst pixel of the difference are below the bounds. With
// AIRLIGHT_TEST_FIGURES they are printed.
inline void agree(const std::string& name, const scene::Film& a, const scene::Film& b, const Bounds& bounds,
                  std::vector<std::string> layers = {}) {
  if (layers.empty()) {
    REQUIRE(a.layers.size() == b.layers.size());
    for (const auto& [layer, values] : a.layers) layers.push_back(layer);
  }
  for (const std::string& layer : layers) {
    const double usual = p99(a, b, layer), worst = quantile(a, b, layer, 1);
    CAPTURE(name, layer, usual, worst);
    CHECK(usual < bounds.p99);
    CHECK(worst < bounds.worst);
    if (std::getenv("AIRLIGHT_TEST_FIGURES"))
      fmt::print("{} {}: p99 {:.1e} of {:.1e}, worst {:.1e} of {:.1e}\n", name, layer, usual, bounds.p99, worst,
                 bounds.worst);
  }
}

}  // namespace airlight::gpu::test
