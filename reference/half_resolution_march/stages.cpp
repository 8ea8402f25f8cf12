#include "reference/half_resolution_march/stages.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/light/background.h"

namespace airlight::half_resolution_march {
namespace {

std::string describe_march(const Options& o) {
  const char* jitter = o.jitter == Jitter::none    ? "at their middles"
                       : o.jitter == Jitter::bayer ? "ordered offsets"
                                                   : "offsets by noise";
  return fmt::format("a ray for each {0}x{0} pixels, {1} steps, {2}, {3}{4}", o.divide, o.steps, jitter,
                     o.analytic ? "analytic" : "Riemann sum",
                     o.frames > 1 ? fmt::format(", {} frames", o.frames) : std::string());
}

}  // namespace

std::vector<scene::Stage> describe_stages(const lit_media::Plan& plan, const Options& o) {
  std::vector<scene::Stage> stages;
  const auto add = [&](const char* name, bool kept, const std::string& reason) {
    stages.push_back({name, kept, reason});
  };
  const scene::Scene& scene = *plan.scene;
  const bool fog = !plan.layers.empty(), lit = !plan.lights.empty();
  const char* no_fog = "no medium with extinction";
  const bool varies = std::any_of(plan.layers.begin(), plan.layers.end(), [](const auto& l) { return l.varies; });
  const double map_bytes = lit_media::map_bytes(plan);
  const bool maps = map_bytes > 0;
  add("light_maps", maps,
      maps
          ? fmt::format("{} lights: {}, {} floats a texel, {}^2 texels of {} steps, {:.3g} MB in all",
                        plan.lights.size(), light_map::encoding_name(o.media.map.encoding),
                        light_map::floats_per_texel(o.media.map), o.media.map.size, o.media.map.steps, 1e-6 * map_bytes)
      : !fog                 ? no_fog
      : !lit                 ? "no light"
      : !o.media.self_shadow ? "self_shadow = none: media do not dim light on its way"
      : !varies              ? "closed form: no medium varies"
                             : "nothing to shadow");
  const bool behind = ends_rays(scene) || seen_behind(scene);
  add("surfaces", behind,
      scene.geometry             ? "first hits, and their light, by film pixel"
      : !scene.backdrops.empty() ? "backdrops are seen through the media"
      : ends_rays(scene)         ? "rays end on the balls of lights"
      : behind                   ? "the environment is seen through the media"
                                 : "nothing behind the media");
  add("march", fog, fog ? describe_march(o) : no_fog);
  add("scattering", plan.scatters,
      plan.scatters ? fmt::format("light scattered once, of {} lights{}", plan.lights.size(),
                                  scene.geometry ? "; surfaces cast shadows" : "")
      : !fog        ? no_fog
      : !lit        ? "no light"
                    : "no medium scatters");
  add("history", fog && o.reproject,
      !fog           ? no_fog
      : !o.reproject ? "reproject = false: no picture goes on from the last one"
                     : fmt::format("the last picture weighs {:.3g}, found by {}{}", o.history_weight,
                                   o.airlight_depth ? "the depth of the airlight" : "the ends of rays",
                                   o.clamp ? "; limited to 3 x 3 marched pixels" : ""));
  add("blur", fog && o.blur,
      !fog               ? no_fog
      : !o.blur          ? "blur = none"
      : ends_rays(scene) ? fmt::format("bilateral; edges of depth: {:.3g} of the longest way through media", o.edge)
                         : "11 x 11 marched pixels; no edges of depth");
  add("composition", true,
      !fog                                  ? no_fog
      : o.divide == 1                       ? "full resolution"
      : o.nearest_depth && ends_rays(scene) ? "upsampled: nearest depth at edges, else bilinear"
                                            : "upsampled: bilinear");
  if (scene::has_environment(scene))
    add("environment_directions", lit && fog,
        fmt::format("{} directions per environment", o.media.environment_directions));
  if (!(scene.ambient_in_scatter == 0).all()) add("ambient", false, "this march has no ambient term");
  return stages;
}

}  // namespace airlight::half_resolution_march
