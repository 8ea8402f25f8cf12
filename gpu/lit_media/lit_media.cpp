#include "gpu/lit_media/lit_media.h"

#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "scene/single_precision.h"

namespace airlight::gpu::lit_media {

using ray_marcher::Columns;

LitMedia::LitMedia(Context& context, const airlight::lit_media::Plan& plan, ray_marcher::GridStorage storage,
                   const FirstHits* first_hits, StageTimer& timer, const std::function<bool(double)>& progress)
    : plan_(plan),
      first_hits_(first_hits),
      lights_(ray_marcher::balls_first(plan.lights)),
      media_(context, plan.layers, ray_marcher::middle_of(plan.layers, plan.scene->camera.position), storage),
      columns_(context, media_, plan.scene->media, plan.layers, lights_,
               needs_maps(plan) ? Columns::Depths::maps : Columns::Depths::none, plan.options.map, timer, progress),
      solids_(context, "spheres and planes", ray_marcher::solid_data(*plan.scene, media_.middle())) {}

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
  solids_.bind(ray_marcher::at::solids);
  program.set("middle_in_tree", Vec3(media_.middle() - first_hits_->tree().middle()));
}

std::vector<std::string> unsupported(const scene::Scene& scene) {
  std::vector<std::string> reasons = scene::beyond_single_precision(scene);
  for (const std::string& reason : ray_marcher::unknown_media(scene.media)) reasons.push_back(reason);
  return reasons;
}

}  // namespace airlight::gpu::lit_media
