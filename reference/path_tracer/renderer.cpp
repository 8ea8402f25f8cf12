#include "reference/path_tracer/renderer.h"

#include <fmt/format.h>

#include <chrono>

#include "reference/path_tracer/cache.h"
#include "reference/path_tracer/stopping.h"
#include "reference/path_tracer/unsupported.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_store.h"

namespace airlight::path_tracer {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class PreparedTracer : public scene::Prepared {
 public:
  PreparedTracer(std::shared_ptr<const scene::Scene> scene, const Options& options)
      : start_(Clock::now()), world_(std::move(scene), options), prepare_seconds_(seconds_since(start_)) {}

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return {{"supergrid", prepare_seconds_}}; }

  scene::Rendering render(const scene::View& view, const scene::Execution& execution) const override {
    if (execution.store) return render_kept(view, execution);
    const auto start = Clock::now();
    Accumulation accumulation = empty_accumulation(world_, view);
    const bool whole = render_to_target(world_, view, execution, accumulation);
    if (accumulation.least_samples() == 0) throw scene::Interrupted("interrupted before every pixel had a sample");
    scene::Rendering rendering;
    const auto traced = Clock::now();
    rendering.film = to_film(world_, view, accumulation);
    rendering.film.metadata["complete"] = whole ? "true" : "false";
    rendering.times = {{"paths", std::chrono::duration<double>(traced - start).count()},
                       {"film", seconds_since(traced)}};
    rendering.counters = accumulation.counters.named();
    return rendering;
  }

 private:
  scene::Rendering render_kept(const scene::View& view, const scene::Execution& execution) const {
    scene::make_private_folder(execution.store->folder());
    CachedRendering kept = render_cached(world_, view, samples_folder(*execution.store), execution);
    for (const std::string& note : kept.notes) execution.store->say(note);
    if (kept.not_kept) execution.store->lost(*kept.not_kept);
    return {std::move(kept.film), {{"paths", kept.seconds}}, kept.counters.named()};
  }

  Clock::time_point start_;
  World world_;
  double prepare_seconds_;
};

std::vector<scene::Stage> PreparedTracer::stages() const {
  const Options& o = world_.options();
  const bool fog = !world_.media().empty();
  bool heterogeneous = false;
  for (const TrackedMedium& medium : world_.media().tracked()) heterogeneous = heterogeneous || !medium.homogeneous;
  const bool geometry = world_.scene().geometry != nullptr;
  const bool environment = !world_.lights().environments().empty();
  const bool capped = std::min(o.max_order < 0 ? 2 : o.max_order, o.max_events < 0 ? 2 : o.max_events) < 2;
  return {
      {"collisions", fog, fog ? "there is a medium" : "no medium has extinction"},
      {"multiple scattering", fog && !capped,
       !fog     ? "no medium has extinction"
       : capped ? "max_order or max_events stops paths before the second scattering"
                : "there is a medium"},
      {"supergrid", heterogeneous && o.supergrid,
       !heterogeneous ? "every medium is homogeneous: exact free flights"
       : o.supergrid  ? "a medium varies in space"
                      : "switched off: one majorant for each medium"},
      {"spectral weights", !world_.media().grey(),
       world_.media().grey() ? "extinction is the same in all channels" : "extinction depends on the channel"},
      {"connections", world_.lights().any_connected(),
       world_.lights().any_connected() ? "a point or spot light is inside or close to a medium"
                                       : "no point or spot light is close to a medium"},
      {"environment weights", environment, environment ? "there is an environment light" : "no environment light"},
      {"surfaces", geometry, geometry ? "the scene has surfaces" : "the scene has no surfaces"},
  };
}

}  // namespace

std::string PathTracer::about() const {
  return "unbiased volume path tracer: delta tracking, next-event estimation, all orders";
}

std::vector<scene::SettingSpec> PathTracer::settings() const { return setting_specs(); }

std::vector<std::string> PathTracer::supports(const scene::Scene& scene, const scene::Settings& settings) const {
  return unsupported(scene, parse_options(settings));
}

std::unique_ptr<scene::Prepared> PathTracer::prepare_supported(std::shared_ptr<const scene::Scene> scene,
                                                               const scene::Settings& settings,
                                                               const scene::Execution&) const {
  return std::make_unique<PreparedTracer>(std::move(scene), parse_options(settings));
}

}  // namespace airlight::path_tracer
