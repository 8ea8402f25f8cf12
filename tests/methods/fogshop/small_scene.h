// A small scene for tests of Fogshop, and pictures of it.
#pragma once
#include <catch2/catch.hpp>

#include "methods/fogshop/fogshop.h"
#include "scene/scene.h"
#include "tests/pictures.h"

namespace fogshop_scenes {

using namespace airlight;
using scene::Scene;
using Pairs = std::map<std::string, std::string>;

inline const fogshop::Fogshop method;

inline scene::Settings settings(const Pairs& given) { return {method.settings(), given}; }

inline scene::Rendering render(const Scene& scene, const Pairs& given = {}, int threads = 1) {
  return airlight::test::render(method, scene, given, threads);
}

// A camera at the origin that looks along -z, a small film, one light.
inline Scene small_scene() {
  Scene scene;
  scene.name = "small";
  scene.width = 12;
  scene.height = 9;
  scene.lights.push_back(scene::PointLight{Point3(1, 2, -3), Rgb(3, 2, 1), 0});
  finish(scene);
  return scene;
}

inline scene::Medium gaussians(const std::vector<scene::Gaussian>& list, double constant = 0) {
  scene::Medium medium;
  medium.name = "fog";
  medium.field = scene::GaussianSum{list, constant, infinity};
  return medium;
}

inline scene::Medium homogeneous(double density) {
  scene::Medium medium;
  medium.field = scene::Homogeneous{density};
  return medium;
}

inline bool kept(const std::vector<scene::Stage>& stages, const std::string& name) {
  for (const auto& stage : stages)
    if (stage.name == name) return stage.kept;
  FAIL("no stage " << name);
  return false;
}

}  // namespace fogshop_scenes
