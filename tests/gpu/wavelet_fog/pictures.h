// Pictures of fogmaps on the device and on the processor.
#pragma once
#include <fmt/ranges.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "gpu/wavelet_fog/wavelet_fog.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/pictures.h"

namespace airlight::gpu::test {

using airlight::test::Given;
using airlight::test::render;

// Patches of fog of that degree between empty ground, W x H pixels of `cell` around the origin.
inline std::shared_ptr<scene::Fogmap> patches(int degree, int width, int height, double cell, unsigned seed,
                                              scene::HeightProfile profile = scene::SameAtAllHeights{}) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      values.push_back(std::max(0.0, std::sin(0.23 * i + seed) * std::sin(0.19 * j + 2 * seed)) *
                       (0.5 + uniform(random)));
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = scene::SplineMap(degree, {{0, 0}, {width, height}}, values);
  fog->profile = std::move(profile);
  fog->cell = cell;
  fog->x0 = -0.5 * cell * (width + degree);
  fog->z0 = -0.5 * cell * (height + degree);
  return fog;
}

inline std::shared_ptr<scene::Scene> scene_of(std::shared_ptr<const scene::Fogmap> fog, double sigma_t,
                                              const Point3& eye, const Point3& at) {
  auto made = std::make_shared<scene::Scene>();
  made->name = "fog";
  made->width = 64, made->height = 48;
  made->camera = scene::look_at(eye, at, Vec3::UnitY());
  made->camera.vertical_fov = 0.9;
  made->ambient_in_scatter = Rgb(0.6, 0.7, 0.8);
  scene::Medium medium;
  medium.field = scene::FogmapPointer(std::move(fog));
  medium.region = scene::Slab{Vec3::UnitY(), -50, 60};
  medium.sigma_t = sigma_t * Rgb(0.9, 1, 1.1);
  made->media = {medium};
  finish(*made);
  return made;
}

inline void compare(const scene::Scene& scene, const Given& given, const scene::Film& a, const scene::Film& b,
                    double bound) {
  agree(fmt::format("{} {}", scene.name, fmt::join(given, " ")), a, b,
        {bound + 10 * injected_error()});  // thin fog's opacity is a difference
}

// Draws a scene on the processor and on the device, and checks that p99 of each layer's difference is below `bound`.
inline void compare(const std::shared_ptr<const scene::Scene>& scene, const Given& given, double bound) {
  Given of_both = given;
  of_both.erase("first_hits");
  const scene::Film a = render(airlight::wavelet_fog::WaveletFog(), scene, of_both).film;
  compare(*scene, given, a, render(gpu::wavelet_fog::WaveletFog(), scene, given).film, bound);
}

}  // namespace airlight::gpu::test
