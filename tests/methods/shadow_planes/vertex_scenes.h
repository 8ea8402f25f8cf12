// Small scenes, and pictures of them by the paper's evaluation at vertices.
#pragma once
#include <cmath>

#include "methods/shadow_planes/shadow_planes.h"
#include "scene/geometry/shapes.h"
#include "tests/pictures.h"

namespace shadow_planes_test {

using namespace airlight;
using airlight::test::Given;
using airlight::test::relative_l2;

inline scene::Rendering render(const std::shared_ptr<const scene::Scene>& scene, const Given& given) {
  return airlight::test::render(shadow_planes::ShadowPlanes(), scene, given);
}

inline double sum(const scene::Film& film) {
  double all = 0;
  for (const float v : film.layer("airlight")) all += v;
  return all;
}

// A box over a floor, between light and floor.
inline std::shared_ptr<scene::Scene> box_in_fog() {
  auto scene = std::make_shared<scene::Scene>();
  scene->name = "box in fog";
  scene->width = 64;
  scene->height = 48;
  scene->camera = scene::look_at({0.5, 1, 5}, {0, 0, 0}, {0, 1, 0});
  scene->lights.emplace_back(scene::PointLight{{0.3, 2.5, -0.4}, Rgb(5, 4, 3), 0.02});
  scene->media.resize(1);
  scene->media[0].sigma_t = Rgb(0.1, 0.2, 0.4);
  scene->surfaces = {{"box", scene::make_box({{-0.2, 0.6, -0.5}, {0.4, 1.0, 0.2}}), scene::Lambert{}},
                     {"floor", scene::Plane{{0, -1, 0}, {0, 1, 0}}, scene::Lambert{}}};
  finish(*scene);
  return scene;
}

// A box and a sphere of fog, shadows of a box in them; all within view.
inline std::shared_ptr<scene::Scene> two_media() {
  auto scene = box_in_fog();
  scene->name = "two media";
  scene->media.resize(2);
  scene->media[0].region = scene::Sphere{{0.9, -0.1, -0.2}, 0.8};
  scene->media[0].sigma_t = Rgb(1, 0.2, 0.2);
  scene->media[1].region = Box{{-1.4, -0.7, -0.8}, {-0.1, 0.4, 0.7}};
  scene->media[1].sigma_t = Rgb(0.2, 0.4, 1.2);
  finish(*scene);
  return scene;
}

inline const Given by_vertices = {{"shadows", "stencil"}, {"evaluation", "vertices"}};
inline Given with(Given given, const Given& more) {
  for (const auto& [key, value] : more) given[key] = value;
  return given;
}

}  // namespace shadow_planes_test
