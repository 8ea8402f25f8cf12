// Pictures of the ray marcher on the device.
#pragma once
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

}  // namespace airlight::ray_marcher
