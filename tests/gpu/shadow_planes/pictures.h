// Pictures of shadow planes on the device and on the processor.
#pragma once
#include <fmt/ranges.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "gpu/shadow_planes/shadow_planes.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "scene/scene.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"

namespace airlight::gpu::test {

using Pairs = std::map<std::string, std::string>;
using airlight::test::render;

inline std::shared_ptr<scene::Scene> scene_of(const std::string& file, int width = 32, int height = 24) {
  return airlight::test::scene_named(file, width, height);
}

// The greatest relative error of any pixel is below `worst`, that of 99 of 100 below `own`: both within 3 times of what is
// measured where a test gives its own; else of the greatest of many. The rule cuts the tail at e^-20 in single, at e^-38 in
// double precision, so few nodes lie elsewhere.
inline void compare(const std::shared_ptr<const scene::Scene>& scene, const Pairs& given, double worst = 1e-5,
                    double own = 2.5e-6, bool lit = true) {
  const scene::Film a = render(airlight::shadow_planes::ShadowPlanes(), scene, given).film;
  // The device's rule: 16 nodes are good to single precision.
  const scene::Film b = render(gpu::shadow_planes::ShadowPlanes(), scene, given).film;
  agree(fmt::format("{} {}", scene->name, fmt::join(given, " ")), a, b, {own, worst},
        {"airlight", "transmittance", "surface", "mean"});
  CHECK((*std::max_element(b.layer("airlight").begin(), b.layer("airlight").end()) > 0) == lit);
}

}  // namespace airlight::gpu::test
