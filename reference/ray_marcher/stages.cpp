#include "reference/ray_marcher/stages.h"

#include <fmt/format.h>

#include "reference/ray_marcher/light_maps.h"
#include "scene/light/background.h"

namespace airlight::ray_marcher {
namespace {

std::string describe_maps(const Plan& plan) {
  const light_map::Options& o = plan.options.map;
  const double bytes = double(plan.lights.size()) * bytes_of_map(light_map::varied_media(plan.scene->media, o), o);
  return fmt::format("{} lights: {}, {} floats a texel, {}^2 texels of {} steps, {:.3g} MB in all", plan.lights.size(),
                     light_map::encoding_name(o.encoding), light_map::floats_per_texel(o), o.size, o.steps,
                     1e-6 * bytes);
}

}  // namespace

std::vector<scene::Stage> describe_stages(const Plan& plan) {
  std::vector<scene::Stage> stages;
  const auto add = [&](const char* name, bool kept, const std::string& reason) {
    stages.push_back({name, kept, reason});
  };
  const scene::Scene& scene = *plan.scene;
  const auto varying = std::count_if(plan.layers.begin(), plan.layers.end(), [](const Layer& l) { return l.varies; });
  const bool constants =
      std::any_of(plan.layers.begin(), plan.layers.end(), [](const Layer& l) { return l.constant > 0; });
  const bool lit = !plan.lights.empty();
  const char* no_light =
      plan.swallowed ? "no light: fog without end lets none come in from infinitely far away" : "no light";
  const bool shadows = !plan.layers.empty() && (plan.scatters || (lit && scene.geometry));
  const Options &o = plan.options, defaults;
  const bool as_stated = o.steps == defaults.steps && o.shadow_steps == defaults.shadow_steps && o.step == 0 &&
                         o.shadow_step == 0 && o.graded && o.early_exit == 0 && o.shadow != Shadow::map;
  add("camera_rays", true,
      std::string("one per pixel, and its steps") + (o.graded ? ", graded" : "") +
          (as_stated
               ? fmt::format("; default steps: airlight within {:.2g} % (relative L2){}", 100 * stated_error(scene),
                             has_environment(scene) ? " of that of the environment's directions" : "")
               : ""));
  add("camera_march", !plan.layers.empty(),
      plan.layers.empty() ? "no medium with extinction" : fmt::format("{} media", plan.layers.size()));
  const bool maps = needs_maps(plan) && varying > 0;
  add("light_maps", maps,
      maps                      ? describe_maps(plan)
      : o.shadow != Shadow::map ? "shadow is not map"
                                : "nothing to shadow");
  add("shadows", shadows,
      !lit                        ? no_light
      : plan.layers.empty()       ? "no medium with extinction"
      : !shadows                  ? "no medium scatters, no surface is lit"
      : varying == 0              ? "closed form: no medium varies"
      : maps                      ? "look-ups in the lights' maps"
      : o.shadow == Shadow::exact ? fmt::format("exact, {} lights", plan.lights.size())
                                  : fmt::format("marched, {} varying media, {} lights", varying, plan.lights.size()));
  add("scattering", plan.scatters, plan.scatters ? "light scattered once" : !lit ? no_light : "no medium scatters");
  add("constant_media", constants,
      constants ? "constants are integrated in closed form" : "no medium has a constant part");
  const bool grids = std::any_of(plan.layers.begin(), plan.layers.end(), [](const Layer& l) { return bool(l.grid); });
  add("empty_space_skipping", grids && plan.options.skip_empty,
      !grids                     ? "no voxel grid"
      : !plan.options.skip_empty ? "empty_space_skipping = false"
                                 : "bricks of 4^3 voxels");
  add("environment_directions", has_environment(scene) && !plan.swallowed,
      !has_environment(scene) ? "no environment light"
      : plan.swallowed        ? no_light
                              : fmt::format("{} directions per environment", plan.options.environment_directions));
  add("occlusion", bool(scene.geometry) && lit, scene.geometry ? "surfaces cast shadows" : "no surfaces");
  const bool seen = (bool(scene.geometry) && lit) || has_environment(scene) || !scene.backdrops.empty();
  add("surfaces", seen,
      scene.geometry && lit      ? "surfaces are lit directly"
      : !scene.backdrops.empty() ? "backdrops are seen through the media"
      : has_environment(scene)   ? "the environment is seen through the media"
                                 : "nothing behind the media");
  if (!(scene.ambient_in_scatter == 0).all()) add("ambient", false, "the ray marcher has no ambient term");
  return stages;
}

}  // namespace airlight::ray_marcher
