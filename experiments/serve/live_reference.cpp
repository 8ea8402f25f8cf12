#include "experiments/serve/live_reference.h"

#include <fmt/format.h>

#include <chrono>

#include "experiments/application/renderers.h"

namespace airlight::experiments::serve {
namespace {

// Orders of scattering where a path could go on for ever: in endless media that absorb nothing.
constexpr int capped_orders = 64;
// Random numbers that no frame of the path tracer uses by default, so that its own error can be seen.
constexpr int stream_of_references = 255;

scene::Settings settings_of(bool all_orders, int most_orders) {
  std::map<std::string, std::string> given{{"stream", std::to_string(stream_of_references)},
                                           {"samples", std::to_string(path_tracer::leaf_samples)}};
  if (!all_orders) given["max_events"] = "1";
  if (most_orders >= 0) given["max_order"] = std::to_string(most_orders);
  return {path_tracer::setting_specs(), given, "reference"};
}

}  // namespace

LiveReference::LiveReference(std::shared_ptr<const scene::Scene> scene, int width, int height, bool all_orders)
    : scene_(std::move(scene)), view_{scene_->camera, width, height}, all_orders_(all_orders) {
  const scene::Renderer& tracer = find_renderer("path_tracer", "reference");
  if (all_orders && !tracer.supports(*scene_, settings_of(all_orders, -1)).empty()) most_orders_ = capped_orders;
  const scene::Settings settings = settings_of(all_orders, int(most_orders_));
  tracer.require_support(*scene_, settings);
  world_ = std::make_unique<path_tracer::World>(scene_, path_tracer::parse_options(settings));
  accumulation_ = path_tracer::empty_accumulation(*world_, view_);
}

bool LiveReference::is_of(const scene::Scene& scene, int width, int height, bool all_orders) const {
  return scene.hash == scene_->hash && width == view_.width && height == view_.height && all_orders == all_orders_;
}

void LiveReference::advance(const scene::Execution& execution, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const scene::Execution until{execution.threads, [&](double done) {
                                 return std::chrono::steady_clock::now() < end && execution.progress(done);
                               }};
  const std::uint64_t begin = samples() / path_tracer::leaf_samples * path_tracer::leaf_samples;
  path_tracer::render_range(*world_, view_, begin, begin + path_tracer::leaf_samples, until, accumulation_);
}

std::shared_ptr<const scene::Film> LiveReference::film() const {
  return std::make_shared<const scene::Film>(path_tracer::to_film(*world_, view_, accumulation_));
}

std::string LiveReference::about() const {
  if (!all_orders_) return "path tracing of light scattered once";
  if (most_orders_ >= 0) return fmt::format("path tracing with up to {} orders of scattering", most_orders_);
  return "path tracing with all orders of scattering";
}

LiveError error_of(const Frame& frame, const scene::Scene& of, const scene::Film& reference, std::uint64_t samples,
                   const std::vector<unsigned char>& left_out) {
  LiveError result;
  if (!frame.film)
    result.missing = "there is no picture";
  else if (frame.scene->hash != of.hash)
    result.missing = "the picture shows another scene or camera than the reference";
  else if (frame.film->width != reference.width || frame.film->height != reference.height)
    result.missing = "the picture has another film than the reference";
  else if (samples < path_tracer::leaf_samples)
    result.missing = "the reference has too few samples";
  else if (!frame.film->has("mean"))
    result.missing = "the picture is not the sum of all its layers";
  if (!result.missing.empty()) return result;
  result.measure = measure({"rel_l2"}, *frame.film, reference, "mean", {left_out, {}},
                           frame.noisy ? ImageNoise::counted : ImageNoise::removed)
                       .front();
  return result;
}

}  // namespace airlight::experiments::serve
