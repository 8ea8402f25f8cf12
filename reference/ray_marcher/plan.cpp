#include "reference/ray_marcher/plan.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/depth.h"
#include "scene/base/place_error.h"

namespace airlight::ray_marcher {

bool too_fine_for_kernels(const scene::Scene& scene) { return scene::place_error(scene) * 0x1p29 > 2e-3; }

double length_unit(const scene::Scene& scene) {
  double unit = infinity;
  for (const scene::Medium& medium : scene.media) unit = std::min(unit, detail(medium.field));
  return unit == infinity ? 1 : unit;
}

namespace {

// Is there no light but lamps so deep in the media, seen from the camera, that the whole picture is as dark as that?
bool only_deep_lamps(const Plan& plan) {
  constexpr double deep = 60;
  const Point3& eye = plan.scene->camera.position;
  return !plan.lights.empty() && std::all_of(plan.lights.begin(), plan.lights.end(), [&](const scene::Light& light) {
    const auto ball = scene::ball(light);
    if (!ball || ball->center == eye) return false;
    const double distance = (ball->center - eye).norm();
    return scene::optical_depth(plan.scene->media, {eye, (ball->center - eye) / distance}, {0, distance}).minCoeff() >
           deep;
  });
}

}  // namespace

Plan make_plan(std::shared_ptr<const scene::Scene> scene, const Options& options, const Plan* before) {
  Plan plan;
  plan.scene = std::move(scene);
  plan.options = options;
  plan.layers = make_layers(plan.scene->media, before ? before->layers : std::vector<Layer>{});
  plan.swallowed = scene::swallows_distant_light(plan.scene->media);
  plan.lights = scene::lights_from_directions(plan.scene->lights, options.environment_directions, plan.swallowed);
  for (const Layer& layer : plan.layers)
    if (!plan.lights.empty() && (layer.medium->albedo * layer.medium->sigma_t > 0).any()) plan.scatters = true;
  if (too_fine_for_kernels(*plan.scene)) plan.options.simd = false;
  // Kernels compute the light of steps in float, too, where what is below 1.2e-38 becomes 0.
  if (only_deep_lamps(plan)) plan.options.simd = false;
  return plan;
}

void add_passes(const Plan& plan, int ray_number, const Ray& ray, double t_end, std::vector<Pass>& passes,
                std::vector<Step>& steps) {
  static thread_local std::vector<Approach> lamps;
  lamps.clear();
  for (const scene::Light& light : plan.lights)
    if (const auto ball = scene::ball(light); ball && plan.scatters) lamps.push_back(approach(ray, ball->center));
  passes.push_back({ray_number, -1, make_spacing(plan.layers, plan.options, ray, t_end, lamps, {}, steps)});
  if (!plan.scatters || !plan.options.graded) return;
  for (int i = 0; i < int(plan.lights.size()); ++i) {
    const auto ball = scene::ball(plan.lights[i]);
    if (!ball) continue;
    const std::size_t before = steps.size();
    const Approach lamp = approach(ray, ball->center);
    const Spacing own = make_spacing(plan.layers, plan.options, ray, t_end, {&lamp, 1}, lamp, steps);
    if (own.around_light)
      passes.push_back({ray_number, i, own});
    else
      steps.resize(before);
  }
}

bool serves(const std::vector<Pass>& passes, std::size_t pass, int light) {
  if (passes[pass].own_light >= 0) return passes[pass].own_light == light;
  for (std::size_t p = pass + 1; p < passes.size() && passes[p].ray == passes[pass].ray; ++p)
    if (passes[p].own_light == light) return false;
  return true;
}

void Counters::operator+=(const Counters& other) {
  rays += other.rays;
  steps += other.steps;
  shadow_rays += other.shadow_rays;
  shadow_steps += other.shadow_steps;
  look_ups += other.look_ups;
  occlusion_rays += other.occlusion_rays;
  ray_seconds += other.ray_seconds;
  march_seconds += other.march_seconds;
  occlusion_seconds += other.occlusion_seconds;
  shadow_seconds += other.shadow_seconds;
  scattering_seconds += other.scattering_seconds;
  surface_seconds += other.surface_seconds;
}

}  // namespace airlight::ray_marcher
