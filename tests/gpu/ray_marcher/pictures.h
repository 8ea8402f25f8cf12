// Pictures of the ray marcher on the device.
#pragma once
#include <cmath>

#include "gpu/ray_marcher/ray_marcher.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace airlight::ray_marcher {

inline scene::View look() {
  scene::View view;
  view.camera = scene::look_at(Point3(0.4, 0.3, 4), Point3(0, 0, 0), Vec3::UnitY());
  view.camera.vertical_fov = 0.7;
  view.width = 13;  // no multiple of a tile
  view.height = 9;
  return view;
}

inline scene::Rendering render_gpu(std::shared_ptr<const scene::Scene> scene, const scene::View& view,
                                   const Given& given) {
  const gpu::ray_marcher::RayMarcher marcher;
  return marcher.prepare(std::move(scene), {marcher.settings(), given}, {1, {}})->render(view, {1, {}});
}

// Boxes that overlap, with a Gaussian in each and a constant in most, under a lamp and a sun.
inline std::shared_ptr<const scene::Scene> scene_of_media(int count) {
  auto scene = std::make_shared<scene::Scene>();
  for (int i = 0; i < count; ++i) {
    const Point3 center(std::sin(i), std::cos(1.7 * i), std::sin(2.3 * i));
    scene::Medium medium;
    medium.field = scene::GaussianSum{{{center, 0.3, 2}}, 0.1 * (i % 3), infinity};
    medium.region = Box{center - Vec3::Constant(0.2), center + Vec3::Constant(0.2 + 0.01 * i)};
    medium.sigma_t = Rgb(0.4, 0.5, 0.6);
    medium.albedo = Rgb::Constant(0.9);
    scene->media.push_back(medium);
  }
  scene->lights = {scene::PointLight{Point3(0.5, 1.5, 1), Rgb(5, 6, 7), 0.05},
                   scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)}};
  finish(*scene);
  return scene;
}

}  // namespace airlight::ray_marcher
