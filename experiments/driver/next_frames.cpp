#include "experiments/driver/next_frames.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"

namespace airlight::experiments {
namespace {

using scene::Fogmap;
using scene::Scene;

bool move_lights(Scene& scene) {
  for (scene::Light& light : scene.lights) light = scene::turned(scene::moved(light, {1e-3, 0, 0}), 1e-3);
  return !scene.lights.empty();
}

template <class Change>
bool change_fogmaps(Scene& scene, const Change& change) {
  bool any = false;
  for (scene::Medium& medium : scene.media)
    if (auto* fog = std::get_if<scene::FogmapPointer>(&medium.field)) {
      auto changed = std::make_shared<Fogmap>(**fog);
      change(*changed);
      *fog = std::move(changed);
      any = true;
    }
  return any;
}

bool move_fog(Scene& scene) {
  return change_fogmaps(scene, [](Fogmap& fog) {
    constexpr double turn = 1e-4;
    const double c = fog.cos_turn, s = fog.sin_turn;
    fog.x0 += 1e-3;
    fog.cos_turn = c * std::cos(turn) - s * std::sin(turn);
    fog.sin_turn = s * std::cos(turn) + c * std::sin(turn);
  });
}

bool thin_fog(Scene& scene) {
  return change_fogmaps(scene, [](Fogmap& fog) {
    std::vector<double> coefficients = fog.map.coefficients();
    for (double& c : coefficients) c *= 0.999;
    fog.map = scene::SplineMap(fog.map.degree(), fog.map.range(), coefficients);
  });
}

struct Kind {
  const char* name;
  const char* whose;
  bool (*move)(Scene&);  // whether there is anything to move
};
constexpr Kind kinds[] = {
    {"lights", "lights", move_lights}, {"fog", "fogmap", move_fog}, {"coefficients", "fogmap", thin_fog}};

}  // namespace

std::vector<std::string> what_may_move() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.push_back(kind.name);
  return names;
}

NextFrames::NextFrames(std::shared_ptr<scene::Prepared> prepared, std::shared_ptr<const Scene> here,
                       const std::string& moving)
    : prepared_(std::move(prepared)), here_(std::move(here)), moving_(moving) {
  auto there = std::make_shared<Scene>(*here_);
  for (const Kind& kind : kinds)
    if (moving == kind.name && !kind.move(*there))
      throw scene::NotSupported("", fmt::format("the scene has no {} that could move", kind.whose));
  there_ = there;
}

scene::Rendering NextFrames::render(const scene::View& view, const scene::Execution& execution) {
  one(there_, view, execution);
  return one(here_, view, execution);
}

std::vector<scene::StageTime> NextFrames::again(const scene::View& view, const scene::Execution& execution) {
  std::swap(here_, there_);
  return one(here_, view, execution).times;
}

scene::Rendering NextFrames::one(const std::shared_ptr<const Scene>& at, const scene::View& view,
                                 const scene::Execution& execution) {
  auto times = prepared_->next(at, execution);
  if (!times) throw scene::NotSupported("", fmt::format("its {} cannot move: every frame is prepared anew", moving_));
  scene::Rendering rendering = prepared_->render(view, execution);
  times->insert(times->end(), rendering.times.begin(), rendering.times.end());
  rendering.times = std::move(*times);
  return rendering;
}

}  // namespace airlight::experiments
