// Pictures of shadow planes on the device and on the processor.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/shadow_planes/shadow_planes_gpu.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"

namespace airlight::gpu::test {

using Pairs = std::map<std::string, std::string>;
using airlight::test::render;

inline std::shared_ptr<scene::Scene> scene_of(const std::string& file, int width = 48, int height = 36) {
  return airlight::test::scene_named(file, width, height);
}

// Pixels of which any channel differs by more than `limit` of itself and 1 % of the greatest; all if one is not finite.
inline int beyond(const scene::Film& a, const scene::Film& b, const std::string& layer, double limit) {
  const std::vector<float>&x = a.layer(layer), &y = b.layer(layer);
  const double most = *std::max_element(x.begin(), x.end());
  int count = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    bool far = false;
    for (std::size_t c = i; c < i + 3; ++c) {
      if (!std::isfinite(x[c]) || !std::isfinite(y[c])) return int(x.size());
      far = far || std::abs(double(y[c]) - x[c]) > limit * (std::abs(x[c]) + 0.01 * most);
    }
    count += far;
  }
  return count;
}

// `own`: the error of the rule itself. It cuts the tail at e^-20 in single, at e^-38 in double precision, so few nodes
// lie elsewhere.
inline void compare(const std::shared_ptr<const scene::Scene>& scene, const Pairs& given, double limit = 1e-4,
                    double own = 1e-5) {
  const scene::Film a = render(shadow_planes::ShadowPlanes(), scene, given).film;
  // The device's rule: 16 nodes are good to single precision.
  const scene::Film b = render(gpu::ShadowPlanesGpu(), scene, given).film;
  CAPTURE(scene->name, given);
  for (const char* layer : {"airlight", "transmittance", "surface", "mean"}) {
    CAPTURE(layer, p99(a, b, layer));
    CHECK(p99(a, b, layer) < own);
    // Coverage is good to 1/256 pixel: a pixel on a silhouette may show what is beside it.
    CHECK(beyond(a, b, layer, limit) <= int(a.pixels()) / 500);
  }
  CHECK(*std::max_element(b.layer("airlight").begin(), b.layer("airlight").end()) > 0);
}

}  // namespace airlight::gpu::test
