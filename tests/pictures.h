// Pictures of any renderer, and how far two of them are apart.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/renderer.h"
#include "scene/scene.h"

namespace airlight::test {

using Given = std::map<std::string, std::string>;

// By the scene's own camera; 0 threads: all.
inline scene::Rendering render(const scene::Renderer& renderer, std::shared_ptr<const scene::Scene> scene,
                               const Given& given = {}, int threads = 1) {
  const scene::View view = view_of(*scene);
  return renderer.prepare(std::move(scene), {renderer.settings(), given}, {threads, {}})->render(view, {threads, {}});
}
inline scene::Rendering render(const scene::Renderer& renderer, const scene::Scene& scene, const Given& given = {},
                               int threads = 1) {
  return render(renderer, std::make_shared<const scene::Scene>(scene), given, threads);
}
inline scene::Film picture(const scene::Renderer& renderer, std::shared_ptr<const scene::Scene> scene,
                           const Given& given = {}, int threads = 1) {
  return render(renderer, std::move(scene), given, threads).film;
}

// By a preparation that goes on from the frame before.
inline scene::Rendering next_frame(scene::Prepared& prepared, const std::shared_ptr<const scene::Scene>& scene) {
  if (!prepared.next(scene, {1, {}})) throw std::runtime_error("the next frame must be prepared anew");
  return prepared.render(view_of(*scene), {1, {}});
}

inline bool all_finite(const scene::Film& film) {
  for (const auto& [layer, values] : film.layers)
    for (const float v : values)
      if (!std::isfinite(v)) return false;
  return true;
}

inline double greatest_difference(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  double most = 0;
  for (std::size_t i = 0; i < a.layer(layer).size(); ++i)
    most = std::max(most, std::abs(double(a.layer(layer)[i]) - b.layer(layer)[i]));
  return most;
}

// Root mean square of a - truth over that of the truth.
inline double relative_l2(const std::vector<float>& a, const std::vector<float>& truth) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    difference += (double(a[i]) - truth[i]) * (double(a[i]) - truth[i]);
    norm += double(truth[i]) * truth[i];
  }
  return difference == 0 ? 0 : std::sqrt(difference / norm);
}
inline double relative_l2(const scene::Film& a, const scene::Film& truth, const std::string& layer = "airlight") {
  return relative_l2(a.layer(layer), truth.layer(layer));
}

// A scene of the experiments, by its name below experiments/scenes.
inline std::shared_ptr<scene::Scene> scene_named(const std::string& name, int width, int height) {
  return std::make_shared<scene::Scene>(
      scene::load_scene(AIRLIGHT_SOURCE_DIR "/experiments/scenes/" + name + ".toml",
                        {{"film.width", std::to_string(width)}, {"film.height", std::to_string(height)}}));
}

}  // namespace airlight::test
