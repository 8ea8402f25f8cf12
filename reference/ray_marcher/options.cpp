#include "reference/ray_marcher/options.h"

#include <algorithm>

#include "reference/ray_marcher/depth.h"

namespace airlight::ray_marcher {

namespace {

// Optical depth from the camera to the deepest lamp in endless fog.
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

namespace {

void bind(scene::SettingBinder& b, Options& o) {
  b.integer("steps", o.steps, 1, 1 << 17, "steps per camera ray, shared among the parts of it that lie in media")
      .where("step", {"0"});
  b.integer("shadow_steps", o.shadow_steps, 1, 1 << 17, "steps per shadow ray in each medium that varies")
      .where("shadow", {"march"})
      .where("shadow_step", {"0"});
  b.real("step", o.step, 0, 1e6,
         "step length on camera rays in voxels of the finest grid (metres without a grid), 0.001 to 1e6; "
         "0: use steps");
  b.real("shadow_step", o.shadow_step, 0, 1e6, "step length on shadow rays, same unit and range; 0: use shadow_steps")
      .where("shadow", {"march"});
  b.choice("spacing", o.graded, {{"graded", true}, {"uniform", false}},
           "graded: steps shrink near point and spot lights and grow along unbounded media; uniform: equal "
           "steps");
  b.choice("shadow", o.shadow, {{"march", Shadow::march}, {"exact", Shadow::exact}, {"map", Shadow::map}},
           "optical depth of shadow rays: by steps, exact, or from a map of each light that is made once");
  b.integer("environment_directions", o.environment_directions, 1, 1 << 16,
            "directions that stand for each environment light");
  b.real("early_exit", o.early_exit, 0, 1, "a camera ray ends where its transmittance falls below this; 0: never");
  b.real("horizon", o.horizon, 1, 700, "optical depth of unbounded medium at which an endless camera ray is cut");
  b.flag("empty_space_skipping", o.skip_empty, "leave out steps where a grid is zero; the image stays the same");
  b.choice("kernel", o.simd, {{"auto", true}, {"scalar", false}},
           "auto: vector kernels in float, scalar: plain loops in double, for checks");
  light_map::bind(b, o.map, "shadow");
}

}  // namespace

std::vector<scene::SettingSpec> option_specs() { return scene::list_settings(bind); }

Options read_options(const scene::Settings& settings, double unit) {
  Options o = scene::read_settings(bind, settings);
  o.step *= unit;
  o.shadow_step *= unit;
  return o;
}

}  // namespace airlight::ray_marcher
