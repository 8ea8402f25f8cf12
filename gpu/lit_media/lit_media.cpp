#include "gpu/lit_media/lit_media.h"

#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "scene/single_precision.h"

namespace airlight::gpu::lit_media {

using ray_marcher::Columns;

namespace {

Columns::Depths depths_of(const airlight::lit_media::Plan& plan) {
  return needs_maps(plan) ? Columns::Depths::maps : Columns::Depths::none;
}

}  // namespace

LitMedia::LitMedia(Context& context, const airlight::lit_media::Plan& plan, ray_marcher::GridStorage storage,
                   const FirstHits* first_hits, StageTimer& timer, const std::function<bool(double)>& progress)
    : context_(context),
      plan_(plan),
      first_hits_(first_hits),
      lights_(ray_marcher::balls_first(plan.lights)),
      media_(context, plan.layers, ray_marcher::middle_of(plan.layers, plan.scene->camera.position), storage),
      columns_(context, media_, plan.scene->media, plan.layers, lights_, depths_of(plan), plan.options.map, timer,
               progress),
      maps_made_(columns_.maps() ? int(lights_.size()) : 0) {
  refill(solids_, context, "spheres and planes", ray_marcher::solid_data(*plan.scene, media_.middle()));
}

bool LitMedia::is_like(const airlight::lit_media::Plan& next) const {
  return media_.is_like(next.layers) && next.scatters == plan_.scatters &&
         columns_.is_like(next.scene->media, next.lights, depths_of(next)) && same_surfaces(*plan_.scene, *next.scene);
}

void LitMedia::become(bool same_media, StageTimer& timer, const std::function<bool(double)>& progress) {
  const Use use(context_);
  lights_ = ray_marcher::balls_first(plan_.lights);
  if (!same_media) {
    media_.become(plan_.layers, ray_marcher::middle_of(plan_.layers, plan_.scene->camera.position));
    refill(solids_, context_, "spheres and planes", ray_marcher::solid_data(*plan_.scene, media_.middle()));
  }
  maps_made_ = columns_.become(media_, plan_.scene->media, plan_.layers, lights_, same_media, timer, progress);
}

std::map<std::string, std::string> LitMedia::definitions() const {
  auto definitions = media_.definitions();
  definitions.merge(columns_.definitions());
  definitions.insert({"OCCLUDERS", plan_.scene->geometry && plan_.scatters ? "1" : "0"});
  return definitions;
}

void LitMedia::bind(LinkedProgram& program) const {
  media_.bind(program);
  columns_.bind(program);
  program.set("lit_lights", plan_.scatters ? int(lights_.size()) : 0);
  program.set("lit_nearest", plan_.nearest);
  if (!plan_.scene->geometry || !plan_.scatters) return;
  first_hits_->tree().bind(program);
  solids_->bind(ray_marcher::at::solids);
  program.set("middle_in_tree", Vec3(media_.middle() - first_hits_->tree().middle()));
}

std::vector<std::string> unsupported(const scene::Scene& scene) {
  std::vector<std::string> reasons = scene::beyond_single_precision(scene);
  for (const std::string& reason : ray_marcher::unknown_media(scene.media)) reasons.push_back(reason);
  return reasons;
}

}  // namespace airlight::gpu::lit_media
