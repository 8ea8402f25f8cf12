#include "experiments/serve/pane.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/application/renderers.h"
#include "gpu/context.h"
#include "scene/base/stopwatch.h"

namespace airlight::experiments::serve {
namespace {

constexpr std::size_t most_times = 30;

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

// A preparation that cannot be moved on still holds for every camera.
void Pane::prepare(const scene::Renderer& renderer, const scene::Settings& settings,
                   std::shared_ptr<const scene::Scene> scene, const scene::Execution& execution, Frame& frame) {
  const std::string key = renderer.name() + " " + settings.canonical();
  if (key != key_) {
    prepared_.reset();
    last_.clear();
  }
  key_ = key;
  // Taken out until it is whole: where next() is interrupted or throws, nothing is known of it.
  const auto before = std::exchange(scene_, nullptr);
  auto there = std::exchange(prepared_, nullptr);
  frame.prepared = "kept";
  if (there && before->hash == scene->hash) {
    prepared_ = std::move(there);
  } else if (there && renderer.supports(*scene, settings).empty()) {
    const auto times = there->next(scene, execution);
    const bool camera_alone = before->matter_hash == scene->matter_hash && before->light_hash == scene->light_hash;
    if (times) {
      frame.prepared = "moved on";
      frame.times = *times;
    }
    if (times || camera_alone) prepared_ = std::move(there);
  }
  if (!prepared_) {
    frame.prepared = "anew";
    prepared_ = renderer.prepare(scene, settings, execution);
    frame.times = prepared_->prepare_times();
  }
  scene_ = std::move(scene);
}

Frame Pane::render(const FrameRequest& request, const std::shared_ptr<const scene::Scene>& scene,
                   const scene::Execution& execution) {
  const scene::Renderer& renderer = find_renderer(request.method, "method");
  const scene::Settings settings(renderer.settings(), request.settings, renderer.name());
  Frame frame;
  frame.scene = scene;
  frame.noisy = renderer.monte_carlo();
  try {
    if (!renderer.device().empty()) gpu::Context::get();  // throws where there is none
    scene::Stopwatch watch;
    prepare(renderer, settings, scene, execution, frame);
    const scene::View view{scene->camera, request.width, request.height};
    scene::Rendering rendering = prepared_->render(view, execution);
    frame.seconds = watch.lap();
    if (!rendering.film.has(request.layer)) {
      frame.refused = fmt::format("{} makes no layer '{}'", renderer.name(), request.layer);
      return frame;
    }
    frame.film = std::make_shared<const scene::Film>(std::move(rendering.film));
    frame.times.insert(frame.times.end(), rendering.times.begin(), rendering.times.end());
    frame.counters = std::move(rendering.counters);
    frame.stages = prepared_->stages();
  } catch (const scene::NotSupported& error) {
    frame.refused = error.reason;
    return frame;
  } catch (const Unavailable& error) {
    frame.refused = fmt::format("not available on this machine: {}", error.what());
    return frame;
  }
  const std::string kind = fmt::format("{} {} {}", frame.prepared, request.width, request.height);
  last_.emplace_back(kind, frame.seconds);
  if (last_.size() > most_times) last_.pop_front();
  std::vector<double> alike;
  for (const auto& [of, seconds] : last_)
    if (of == kind) alike.push_back(seconds);
  frame.median_frames = int(alike.size());
  frame.median = median_of(std::move(alike));
  return frame;
}

}  // namespace airlight::experiments::serve
