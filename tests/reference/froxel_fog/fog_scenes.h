// Scenes and pictures for the tests of froxel fog.
#pragma once
#include "reference/froxel_fog/froxel_fog.h"
#include "tests/pictures.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace airlight::froxel_fog {

using ray_marcher::make_medium;
using ray_marcher::make_scene;
using test::Given;

inline std::shared_ptr<scene::Scene> fog_scene(std::vector<scene::Medium> media, std::vector<scene::Light> lights,
                                               const scene::Camera& camera, int width, int height) {
  auto scene = make_scene(std::move(media), std::move(lights));
  scene->camera = camera;
  scene->width = width;
  scene->height = height;
  finish(*scene);
  return scene;
}

// Looks along -z from z = 3, rays parallel, one metre high.
inline scene::Camera parallel_camera() {
  scene::Camera camera;
  camera.kind = scene::Camera::Kind::orthographic;
  camera.position = Point3(0, 0, 3);
  return camera;
}

inline scene::Camera wide_camera() {
  scene::Camera camera = scene::look_at(Point3(0.3, 0.4, 3.0), Point3(0.1, 0.1, 0), Vec3::UnitY());
  camera.vertical_fov = 0.9;
  return camera;
}

inline scene::Film fog(const std::shared_ptr<const scene::Scene>& scene, const Given& given, int threads = 0) {
  return test::picture(FroxelFog(), scene, given, threads);
}

// Greatest relative distance of a layer from one value everywhere.
inline double distance_from(const scene::Film& film, const std::string& layer, const Rgb& value) {
  double most = 0;
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x)
      most = std::max(most, ((film.get(layer, x, y) - value) / value).abs().maxCoeff());
  return most;
}

}  // namespace airlight::froxel_fog
