// Scenes made in code for the ray marcher's tests, and one-ray shortcuts.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "reference/ray_marcher/light_maps.h"
#include "reference/ray_marcher/plan.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "reference/ray_marcher/scalar.h"
#include "scene/scene.h"

namespace airlight::ray_marcher {

using Given = std::map<std::string, std::string>;

inline std::shared_ptr<scene::Scene> make_scene(std::vector<scene::Medium> media, std::vector<scene::Light> lights) {
  auto scene = std::make_shared<scene::Scene>();
  scene->name = "test";
  scene->media = std::move(media);
  scene->lights = std::move(lights);
  finish(*scene);
  return scene;
}

inline scene::Medium make_medium(scene::DensityField field, scene::Region region, const Rgb& sigma_t, const Rgb& albedo,
                                 scene::PhaseFunction phase = scene::Isotropic{}) {
  scene::Medium medium;
  medium.field = std::move(field);
  medium.region = std::move(region);
  medium.sigma_t = sigma_t;
  medium.albedo = albedo;
  medium.phase = phase;
  return medium;
}

inline Plan plan_for(std::shared_ptr<const scene::Scene> scene, const Given& given, double unit = 1) {
  Plan plan = make_plan(std::move(scene), read_options(scene::Settings(option_specs(), given), unit));
  make_light_maps(plan, {});
  return plan;
}

// The plain path along one ray, `n` steps on camera and shadow rays.
inline Pixel march(std::shared_ptr<const scene::Scene> scene, const Ray& ray, int n, Given given = {},
                   double t_end = infinity) {
  given["steps"] = given["shadow_steps"] = std::to_string(n);
  given = scene::without_unread(option_specs(), given);
  Counters counters;
  return march_media(plan_for(std::move(scene), given), ray, t_end, counters);
}

inline scene::Rendering render(std::shared_ptr<const scene::Scene> scene, const scene::View& view, const Given& given,
                               int threads = 0) {
  const RayMarcher marcher;
  return marcher.prepare(std::move(scene), scene::Settings(marcher.settings(), given), {})->render(view, {threads, {}});
}

// A grid of smooth smoke with empty space around it, size^3 samples, values in [0, 1].
std::shared_ptr<const scene::VoxelGrid> make_smoke(int size, double voxel, const Vec3& corner, const Mat3& rotation,
                                                   bool clamp_border = false);

// One scene of each kind that the marcher knows: media, regions, phases, lights, surfaces; all around the origin, about
// 2 m wide.
std::vector<std::pair<std::string, std::shared_ptr<const scene::Scene>>> assorted_scenes();

// The scene with all lengths multiplied by `scale`: the picture from the scaled camera is unchanged.
std::shared_ptr<const scene::Scene> scaled_scene(const scene::Scene&, double scale);

inline scene::View small_view() {
  scene::View view;
  view.camera = scene::look_at(Point3(0.3, 0.4, 3.0), Point3(0.1, 0.1, 0), Vec3::UnitY());
  view.camera.vertical_fov = 0.9;
  view.width = 21;  // not a multiple of tiles or lanes
  view.height = 17;
  return view;
}

}  // namespace airlight::ray_marcher
