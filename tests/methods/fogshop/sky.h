// A small scene under a sky, and Fogshop's pictures of it.
#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "methods/fogshop/fogshop.h"
#include "scene/scene.h"
#include "tests/pictures.h"

namespace airlight::fogshop::test {

using scene::Film;
using scene::Scene;
using Pairs = std::map<std::string, std::string>;

inline const Fogshop method;

inline scene::Rendering render(const Scene& scene, const Pairs& given = {}, int threads = 1) {
  return airlight::test::render(method, scene, given, threads);
}

inline bool kept(const Scene& scene, const std::string& name, const Pairs& given = {}) {
  const scene::Settings settings(method.settings(), given);
  for (const auto& stage : method.prepare(std::make_shared<const Scene>(scene), settings, {1, {}})->stages())
    if (stage.name == name) return stage.kept;
  FAIL("no stage " << name);
  return false;
}

// Sixteen coefficients of a sky that is positive everywhere, brighter in one direction, coloured.
inline std::vector<Rgb> sky() {
  std::vector<Rgb> c(16, Rgb::Zero());
  c[0] = Rgb(4, 4, 4);
  for (int i = 1; i < 16; ++i) c[i] = Rgb(0.3 * std::cos(i), 0.25 * std::sin(2 * i + 1), 0.3 * std::cos(5 * i + 2));
  return c;
}

inline scene::EnvironmentLight sky_light() { return scene::make_sh_environment(sky(), Mat3::Identity(), Rgb::Ones()); }

// A camera at the origin that looks along -z into two Gaussians.
inline Scene gaussians_under(const scene::Light& light) {
  Scene scene;
  scene.name = "sky";
  scene.width = 6;
  scene.height = 4;
  scene.lights.push_back(light);
  scene::Medium medium;
  medium.name = "fog";
  medium.field = scene::GaussianSum{
      {{Point3(0.5, 0.2, -4), 1, 0.5}, {Point3(-1, 0.5, -3), 0.6, 1}, {Point3(0.3, 0, 3), 0.9, 0.4}}, 0, infinity};
  scene.media.push_back(medium);
  finish(scene);
  return scene;
}

inline Ray pixel_ray(const Scene& s, int x, int y) { return camera_ray(s.camera, x + 0.5, y + 0.5, s.width, s.height); }

}  // namespace airlight::fogshop::test
