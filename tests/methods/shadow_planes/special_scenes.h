// Scenes as they are made by hand, where camera, light and edges share planes: whatever rounding decides there must be
// decided once.
#pragma once
#include <memory>
#include <vector>

#include "scene/geometry/shapes.h"
#include "scene/scene.h"

namespace airlight::test {

// Every pixel of them is lit or dark as a shadow ray would have it.
inline std::vector<std::shared_ptr<const scene::Scene>> special_scenes() {
  std::vector<std::shared_ptr<const scene::Scene>> scenes;
  const auto add = [&](const char* name, const Point3& camera, const Point3& target, const Point3& light,
                       std::vector<scene::Surface> surfaces) {
    auto scene = std::make_shared<scene::Scene>();
    scene->name = name;
    scene->width = 32;
    scene->height = 24;
    scene->camera = scene::look_at(camera, target, {0, 1, 0});
    scene->media.resize(1);
    scene->media[0].sigma_t = Rgb(0.15, 0.15, 0.3);
    scene->lights.emplace_back(scene::PointLight{light, Rgb(20, 15, 10), 0});
    scene->surfaces = std::move(surfaces);
    finish(*scene);
    scenes.push_back(scene);
  };
  const auto box = [](const Point3& lo, const Point3& hi) {
    return scene::Surface{"box", scene::make_box({lo, hi}), scene::Lambert{}};
  };
  const auto ground = [](double y) {
    return scene::Surface{"ground", scene::Plane{{0, y, 0}, {0, 1, 0}}, scene::Lambert{}};
  };
  scene::TriangleMesh card;
  card.vertices = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  card.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  add("a card with both sides, the camera in its shadow", {0.2, -1.1, 0.3}, {3, -1.5, 1}, {0.1, 2.3, 0.2},
      {{"card", card, scene::Lambert{}}, ground(-4)});
  add("the same from beside it", {3.1, 1.2, 4.3}, {0, -0.5, 0}, {0.1, 2.3, 0.2},
      {{"card", card, scene::Lambert{}}, ground(-4)});
  add("light and camera in the plane of a face", {0, 0.7, 5}, {0.13, 0.6, 0}, {0, 3.3, 1.2},
      {box({0, 1.5, 2}, {1, 1.8, 3.5}), ground(-1)});
  add("light and camera in the plane of an edge", {2.2, 0, 0.3}, {0.5, 1.9, 0}, {0, 2.2, 0.1},
      {box({1, -5, -1}, {1.2, 1, 1})});
  add("the camera behind the diagonals of two faces, a box as high as the light", {-5, 1, 0}, {0, 1.07, 0.03},
      {5, 1, 0}, {box({-1, 0, -1}, {1, 2, 1}), box({-1, 0.13, -4.3}, {1.2, 1, -3.1})});
  add("the camera on the tangent cone of a sphere, looking away from its shadow", {3.75, 0, 0}, {6, 0.5, 0.2},
      {0, 5, 0}, {{"ball", scene::Sphere{{0, 0, 0}, 3}, scene::Lambert{}}});
  add("a light closely before a wall of a box", {4, 2.1, 1.3}, {0, 1, 0}, {0.3, 1, 0.2},
      {box({-1, -1, -1}, {1, 1 - 1e-6, 1})});
  scene::TriangleMesh fins;  // three triangles on one edge
  fins.vertices = {{0, 0, -1}, {0, 0, 1}, {1, 0.3, 0}, {-1, 0.2, 0}, {0.1, 1, 0}};
  fins.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  add("triangles that share an edge", {2.2, 1.4, 4}, {0, -0.3, 0}, {0.4, 2.3, 0.5},
      {{"fins", fins, scene::Lambert{}}, ground(-2)});
  return scenes;
}

}  // namespace airlight::test
