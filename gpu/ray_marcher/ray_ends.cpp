#include "gpu/ray_marcher/ray_ends.h"

#include <algorithm>

#include "scene/light/background.h"

namespace airlight::gpu::ray_marcher {
namespace {

bool has_balls(const scene::Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& light) {
    const auto ball = scene::ball(light);
    return ball && ball->radius > 0;
  });
}

}  // namespace

RayEnds::RayEnds(Context& context, const scene::Scene& scene, FirstHits::Way way) {
  if (scene.geometry || has_balls(scene)) surfaces_ = std::make_unique<FirstHits>(context, scene, true, way);
  if (!scene.backdrops.empty()) backdrops_ = std::make_unique<Backdrops>(context, scene);
}

bool RayEnds::become(const scene::Scene& before, const scene::Scene& scene) {
  if (backdrops_ || !scene.backdrops.empty() || !same_surfaces(before, scene)) return false;
  return surfaces_ ? surfaces_->move_balls(scene) : !has_balls(scene);
}

std::vector<scene::Stage> RayEnds::stages() const {
  return {{"distances", bool(surfaces_), surfaces_ ? "where camera rays end" : "nothing ends a ray"},
          {"backdrops", bool(backdrops_), backdrops_ ? "where they end camera rays" : "there are none"}};
}

FilmOnDevice RayEnds::begin_film(const scene::View& view, Frame& frame) const {
  const std::size_t pixels = std::size_t(view.width) * view.height;
  const auto layer = [&](const char* name) -> const Buffer& {
    const Buffer& buffer = frame.buffers.get(name, 12 * pixels);
    frame.download.add(name, buffer, 12 * pixels);
    return buffer;
  };
  FilmOnDevice film{nullptr,          nullptr,      nullptr, layer("airlight"), layer("transmittance"),
                    layer("surface"), layer("mean")};
  if (surfaces_ || backdrops_) film.distances = &frame.buffers.get("distances", 4 * pixels);
  if (surfaces_) {
    film.primitives = &frame.buffers.get("primitives", 4 * pixels);
    frame.timer.begin("distances");
    surfaces_->find(view, *film.distances, film.primitives);
  }
  if (backdrops_) {
    film.seen = &frame.buffers.get("seen", 12 * pixels);
    frame.timer.begin("backdrops");
    backdrops_->find(view, *film.distances, bool(surfaces_), *film.seen);
  }
  return film;
}

bool something_behind(const scene::Scene& scene, std::size_t lights) {
  return (scene.geometry && lights > 0) || has_environment(scene) || !scene.backdrops.empty();
}

std::vector<double> totals_of(const Download& download, const std::string& name) {
  const std::vector<unsigned> words = download.values<unsigned>(name);
  std::vector<double> totals;
  for (std::size_t i = 0; i + 1 < words.size(); i += 2)
    totals.push_back(double(words[i]) + 4294967296.0 * double(words[i + 1]));
  return totals;
}

void clear_film(scene::Rendering& result, const scene::Execution& execution) {
  for (const char* name : {"mean", "airlight", "surface", "transmittance"})
    if (!execution.layers || execution.layers->count(name) != 0)
      result.film.layers[name].assign(3 * result.film.pixels(), name[0] == 't' ? 1.0f : 0.0f);
  result.counters = Traffic().counters();
}

}  // namespace airlight::gpu::ray_marcher
