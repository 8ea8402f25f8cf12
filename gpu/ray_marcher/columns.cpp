#include "gpu/ray_marcher/columns.h"

#include <algorithm>

#include "gpu/line_series.h"
#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "scene/media/legendre_box.h"

namespace airlight::gpu::ray_marcher {
namespace {

std::vector<char> bytes_of(const std::vector<LightData>& lights) {
  const auto* bytes = reinterpret_cast<const char*>(lights.data());
  return {bytes, bytes + lights.size() * sizeof(LightData)};
}

// So many points tell the polynomials along rays through the media's Legendre boxes; 0: none asks for them.
int points_of(const std::vector<scene::Medium>& media, Columns::Depths depths) {
  int most = 0;
  for (const scene::Medium& medium : media)
    if (const auto* box = std::get_if<scene::LegendrePointer>(&medium.field); box && depths == Columns::Depths::exact) {
      const scene::TensorShape& n = (*box)->shape();
      most = std::max(most, n[0] + n[1] + n[2] - 2);
    }
  return most;
}

}  // namespace

Columns::Columns(Context& context, const MediaOnDevice& media, const std::vector<scene::Medium>& in_scene,
                 const std::vector<airlight::ray_marcher::Layer>& layers, const std::vector<scene::Light>& lights,
                 Depths depths, const airlight::light_map::Options& options, StageTimer& timer,
                 const std::function<bool(double)>& progress)
    : depths_(depths),
      count_(lights.size()),
      lights_uploaded_(bytes_of(light_data(lights, media.middle()))),
      lights_(context, "lights", lights_uploaded_),
      points_(points_of(in_scene, depths)) {
  if (points_ > 0) rule_ = std::make_unique<Buffer>(context, "rule along rays", line_series(points_).values);
  if (depths != Depths::maps) return;
  timer.stage("upload");
  maps_ = std::make_unique<light_map::LightMaps>(context, media, in_scene, layers, lights, options, progress);
  timer.stage("light_maps");
}

bool Columns::is_like(const std::vector<scene::Medium>& media, const std::vector<scene::Light>& lights,
                      Depths depths) const {
  return lights.size() == count_ && depths == depths_ && points_of(media, depths) == points_ &&
         (!maps_ || maps_->fits(media, lights));
}

int Columns::become(const MediaOnDevice& media, const std::vector<scene::Medium>& in_scene,
                    const std::vector<airlight::ray_marcher::Layer>& layers, const std::vector<scene::Light>& lights,
                    bool same_media, StageTimer& timer, const std::function<bool(double)>& progress) {
  if (std::vector<char> now = bytes_of(light_data(lights, media.middle())); now != lights_uploaded_) {
    lights_.upload(now);
    lights_uploaded_ = std::move(now);
  }
  if (!maps_) return 0;
  timer.stage("upload");
  const int made = maps_->become(media, in_scene, layers, lights, same_media, progress);
  if (made > 0) timer.stage("light_maps");
  return made;
}

std::map<std::string, std::string> Columns::definitions() const {
  auto definitions = maps_ ? maps_->definitions() : std::map<std::string, std::string>{};
  definitions["DEPTHS"] = std::to_string(int(depths_));
  if (rule_) definitions.merge(line_series(points_).definitions);
  return definitions;
}

void Columns::bind(LinkedProgram& program, const airlight::ray_marcher::Options& o) const {
  lights_.bind(at::lights);
  if (maps_) maps_->bind(program);
  if (rule_) rule_->bind_as(GL_UNIFORM_BUFFER, at::line_rule);
  if (depths_ != Depths::columns) return;
  program.set("skip_empty", o.skip_empty);
  program.set("shadow_steps", o.shadow_steps);
  program.set("shadow_step", o.shadow_step);
  program.set("deepest_shadow_step", deepest_shadow_step(o));
}

}  // namespace airlight::gpu::ray_marcher
