#include "reference/froxel_fog/stages.h"

#include <fmt/format.h>

#include "reference/froxel_fog/fit.h"
#include "reference/froxel_fog/volume.h"
#include "scene/light/background.h"

namespace airlight::froxel_fog {
namespace {

std::string describe_grid(const scene::Scene& scene, const Options& o, Interval media, Interval range) {
  const Cells cells = cells_of(o, scene.width, scene.height);
  const Slices slices(o.slices, range, o.depth, o.depth == Distribution::log ? o.log_c : o.exponent);
  return fmt::format(
      "{} x {} x {} froxels of {:.3g} x {:.3g} pixels from {:.3g} to {:.3g} m; {:.3g} slices cover media",
      cells.columns, cells.rows, o.slices, cells.width, cells.height, range.lo, range.hi,
      media.empty() ? 0 : o.slices * (slices.encode(media.hi) - slices.encode(media.lo)));
}

// The part of the media that the range leaves out, as text; empty if there is none.
std::string beyond(Interval media, Interval range) {
  if (range.empty()) return fmt::format("media from {:.3g} to {:.3g} m lie before near", media.lo, media.hi);
  if (media.lo >= range.lo && media.hi <= range.hi) return "";
  return fmt::format("media from {:.3g} to {:.3g} m are cut to {:.3g} to {:.3g} m; what lies outside is not seen",
                     media.lo, media.hi, range.lo, range.hi);
}

}  // namespace

std::vector<scene::Stage> describe_stages(const lit_media::Plan& plan, const Options& o, const std::string& settings) {
  const scene::Scene& scene = *plan.scene;
  std::vector<scene::Stage> stages;
  const auto add = [&](const char* name, bool kept, const std::string& reason) {
    stages.push_back({name, kept, reason});
  };
  const Interval media = media_depths(plan, view_of(scene), {}), range = slice_range(o, media);
  const bool seen = !plan.layers.empty() && !range.empty(), lights = !plan.lights.empty();
  const char* const nothing = plan.layers.empty() ? "no medium with extinction"
                              : media.empty()     ? "no ray meets a medium"
                                                  : "no medium lies in the range";
  if (o.preset != Preset::fitted) add("preset", true, settings);
  const double bytes = map_bytes(plan);
  add("light_maps", bytes > 0,
      bytes > 0             ? fmt::format("{} lights, {}, {:.3g} MB", plan.lights.size(),
                                          light_map::encoding_name(o.media.map.encoding), 1e-6 * bytes)
      : o.media.self_shadow ? "nothing that varies to shadow"
                            : "self_shadow = none: media dim no light on its way, and are too bright");
  add("fit", o.far == 0, o.far == 0 ? "near and far from where the media begin and end" : "near and far are set");
  add("inject", seen, seen ? describe_grid(scene, o, media, range) : nothing);
  add("scattering", seen && plan.scatters,
      plan.scatters ? "light scattered once"
      : lights      ? "no medium scatters"
                    : "no light, or none that fog without end lets in");
  add("history", seen && (o.frames > 1 || o.reproject),
      o.reproject    ? "the last picture of this preparation, moved to the camera"
      : o.frames > 1 ? fmt::format("{} jittered frames of a still view", o.frames)
                     : "one frame");
  add("filter", seen && o.filter != Filter::none,
      o.filter == Filter::none     ? "filter = none"
      : o.filter == Filter::gauss3 ? "3 x 3 froxels of each slice"
                                   : "7 froxels on three axes");
  add("integrate", seen, seen ? "columns of froxels, front to back" : nothing);
  add("picture", true, "trilinear look-ups");
  if (!media.empty())
    if (const std::string cut = beyond(media, range); !cut.empty()) add("media_outside_range", false, cut);
  add("environment_directions", has_environment(scene) && lights,
      !has_environment(scene) ? "no environment light"
      : lights                ? fmt::format("{} directions per environment", o.media.environment_directions)
                              : "fog without end lets no light in");
  add("occlusion", bool(scene.geometry) && lights, scene.geometry ? "surfaces cast shadows" : "no surfaces");
  add("surfaces", (scene.geometry && lights) || has_environment(scene) || !scene.backdrops.empty(),
      scene.geometry && lights   ? "surfaces are lit directly"
      : !scene.backdrops.empty() ? "backdrops are seen through the media"
      : has_environment(scene)   ? "the environment is seen through the media"
                                 : "nothing behind the media");
  if (!(scene.ambient_in_scatter == 0).all()) add("ambient", false, "froxel fog has no ambient term");
  return stages;
}

}  // namespace airlight::froxel_fog
