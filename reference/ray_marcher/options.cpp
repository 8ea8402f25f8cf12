#include "reference/ray_marcher/options.h"

#include <algorithm>

#include "reference/ray_marcher/depth.h"

namespace airlight::ray_marcher {

namespace {

// Of lamps in endless fog: the depth of the deepest, seen from the camera.
double deepest_lamp(const scene::Scene& scene) {
  double deepest = 0;
  for (const scene::Medium& medium : scene.media) {
    const auto density = homogeneous_density(medium.field);
    if (!density || bounding_box(medium).size().allFinite()) continue;
    const double extinction = medium.sigma_t.maxCoeff() * *density;
    for (const scene::Light& light : scene.lights)
      if (const auto lamp = scene::ball(light))
        deepest = std::max(deepest, extinction * (lamp->center - scene.camera.position).norm());
  }
  return deepest;
}

}  // namespace

double stated_error(const scene::Scene& scene) {
  const double thick = most_whole * Options().horizon;  // through all of a medium, in equal steps
  const auto divides = [&](const scene::Medium& medium) {
    const Box box = bounding_box(medium);
    return !box.empty() && box.size().allFinite() &&
           medium.sigma_t.maxCoeff() * density_bounds(medium, box).hi * box.size().stableNorm() > thick;
  };
  if (scene.geometry) return 0.08;
  const bool divided = std::any_of(scene.media.begin(), scene.media.end(), divides);
  // On the way to a lamp a step of depth y brings sinh(y/2)/(y/2) times its light.
  const double y = deepest_lamp(scene) / Options().steps;
  return std::max(divided ? 0.04 : 0.015, y * y / 20);
}

std::vector<scene::SettingSpec> option_specs() {
  return {
      scene::integer_setting("steps", "64", 1, 1 << 17,
                             "steps per camera ray, shared among the parts of it that lie in media"),
      scene::integer_setting("shadow_steps", "32", 1, 1 << 17, "steps per shadow ray in each medium that varies"),
      scene::real_setting(
          "step", "0", 0, 1e6,
          "step length on camera rays in voxels of the finest grid (metres without a grid), 0.001 to 1e6; "
          "0: use steps"),
      scene::real_setting("shadow_step", "0", 0, 1e6,
                          "step length on shadow rays, same unit and range; 0: use shadow_steps"),
      scene::choice_setting(
          "spacing", "graded", {"graded", "uniform"},
          "graded: steps shrink near point and spot lights and grow along unbounded media; uniform: equal "
          "steps"),
      scene::choice_setting("shadow", "march", {"march", "exact"}, "optical depth of shadow rays: by steps, or exact"),
      scene::integer_setting("environment_directions", "256", 1, 1 << 16,
                             "directions that stand for each environment light"),
      scene::real_setting("early_exit", "0", 0, 1,
                          "a camera ray ends where its transmittance falls below this; 0: never"),
      scene::real_setting("horizon", "16", 1, 700,
                          "optical depth of unbounded medium at which an endless camera ray is cut"),
      scene::flag_setting("empty_space_skipping", true,
                          "leave out steps where a grid is zero; the image stays the same"),
      scene::choice_setting("kernel", "auto", {"auto", "scalar"},
                            "auto: vector kernels in float, scalar: plain loops in double, for checks"),
  };
}

Options read_options(const scene::Settings& settings, double unit) {
  Options o;
  o.steps = int(settings.integer("steps"));
  o.shadow_steps = int(settings.integer("shadow_steps"));
  o.step = settings.real("step") * unit;
  o.shadow_step = settings.real("shadow_step") * unit;
  o.graded = settings.text("spacing") == "graded";
  o.exact_shadow = settings.text("shadow") == "exact";
  o.simd = settings.text("kernel") == "auto";
  o.skip_empty = settings.flag("empty_space_skipping");
  o.environment_directions = int(settings.integer("environment_directions"));
  o.early_exit = settings.real("early_exit");
  o.horizon = settings.real("horizon");
  return o;
}

}  // namespace airlight::ray_marcher
