#include "reference/half_resolution_march/half_resolution_march.h"

#include <fmt/format.h>

#include <mutex>
#include <utility>

#include "reference/half_resolution_march/filter.h"
#include "reference/half_resolution_march/history.h"
#include "reference/half_resolution_march/limits.h"
#include "reference/half_resolution_march/stages.h"
#include "scene/base/limits.h"
#include "scene/base/stopwatch.h"

namespace airlight::half_resolution_march {
namespace {

// A part of a picture, whose progress is that share of the whole.
scene::Execution part_of(const scene::Execution& execution, Interval share) {
  scene::Execution part = execution;
  if (execution.progress)
    part.progress = [&execution, share](double fraction) {
      return execution.progress(share.lo + fraction * share.length());
    };
  return part;
}

// `before`: the media of the frame before, which are kept where they still hold; may be null.
Plan make_plan(std::shared_ptr<const scene::Scene> scene, const Options& options, const scene::Execution& execution,
               const lit_media::LitMedia* before = nullptr) {
  auto media = std::make_shared<const lit_media::LitMedia>(scene, options.media, execution, before);
  return {std::move(scene), options, std::move(media)};
}

class PreparedHalfResolutionMarch final : public scene::Prepared {
 public:
  PreparedHalfResolutionMarch(Plan plan, std::string settings, double seconds)
      : plan_(std::move(plan)),
        settings_(std::move(settings)),
        prepare_seconds_(seconds),
        maps_made_(plan_.media->maps_made()) {}

  std::vector<scene::Stage> stages() const override { return describe_stages(plan_.media->plan(), plan_.options); }

  std::vector<scene::StageTime> prepare_times() const override {
    const double maps = plan_.media->map_seconds();
    std::vector<scene::StageTime> times = {{"prepare", prepare_seconds_ - maps}};
    if (maps > 0 && plan_.media->map_bytes() > 0) times.push_back({"light_maps", maps});
    return times;
  }

  scene::Rendering render(const scene::View& view, const scene::Execution& execution) const override {
    const scene::Scene& scene = *plan_.scene;
    require_own_camera(scene, view);
    scene::require_memory(bytes_needed(plan_, view), "half_resolution_march: a picture of this size");
    scene::Rendering result;
    result.film = scene::Film(view.width, view.height);
    const scene::PictureLayers layers(result.film, {});
    result.film.metadata = {
        {"method", "half_resolution_march"}, {"settings", settings_}, {"scene", scene.name}, {"hash", scene.hash}};
    Counters counters;
    scene::Stopwatch watch;
    const auto lap = [&](const char* stage) { result.times.push_back({stage, watch.lap()}); };
    Behind behind;
    if (ends_rays(scene) || seen_behind(scene)) {
      behind = look_behind(plan_, view, part_of(execution, {0, 0.2}), counters);
      lap("surfaces");
    }
    LowFilm low(view.width, view.height, plan_.options.divide);
    if (!plan_.media->layers().empty()) {
      const History* last = history_ && history_->fits(view) ? &*history_ : nullptr;
      Marched marched = march_blocks(plan_, view, behind, pictures_, last ? &last->view : nullptr,
                                     part_of(execution, {0.2, 0.8}), counters);
      low = std::move(marched.film);
      lap("march");
      if (last) {
        blend(plan_.options, *last, marched.traces, plan_.options.edge * counters.longest, low,
              part_of(execution, {0.8, 0.85}), counters);
        lap("history");
      }
      if (plan_.options.reproject) keep(low, view);
    }
    const double edge = plan_.options.edge * counters.longest;
    if (plan_.options.blur && edge > 0) {
      blur(low, edge, part_of(execution, {0.85, 0.9}));
      lap("blur");
    }
    compose(plan_, view, low, edge, behind, layers, part_of(execution, {0.9, 1}));
    lap("composition");
    if (const std::string doubt = doubt_of(*plan_.media, plan_.options, scene, view); !doubt.empty())
      result.film.metadata["warning"] = "half_resolution_march: " + doubt;
    result.counters = {{"rays", double(counters.rays)},
                       {"points", double(counters.media.points)},
                       {"look_ups", double(counters.media.look_ups)},
                       {"occlusion_rays", double(counters.media.occlusion_rays)},
                       {"pixels_behind", double(counters.pixels)}};
    if (plan_.options.media.self_shadow) result.counters["light_maps_made"] = maps_made_;
    if (plan_.options.reproject) {
      result.counters["history_used"] = double(counters.history_used);
      result.counters["history_rejected"] = double(counters.history_rejected);
    }
    if (plan_.options.clamp) result.counters["history_clamped"] = double(counters.history_clamped);
    return result;
  }

  // Keeps the layers of media and the maps of lights that still hold. With reproject the last picture becomes the history of the next.
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const scene::Scene> scene,
                                                    const scene::Execution& execution) override {
    const scene::Scene& now = *plan_.scene;
    const bool same =
        lit_media::fits(plan_.media->plan(), *scene) && scene->width == now.width && scene->height == now.height;
    if (!same && !unsupported(*scene, plan_.options).empty()) return std::nullopt;
    std::vector<scene::StageTime> times;
    if (same) {
      plan_.scene = std::move(scene);
    } else {
      scene::Stopwatch watch;
      plan_ = make_plan(std::move(scene), plan_.options, execution, plan_.media.get());
      prepare_seconds_ = watch.lap();
      times = prepare_times();
    }
    maps_made_ = same ? 0 : plan_.media->maps_made();
    if (!plan_.options.reproject) return times;
    if (last_) history_ = std::exchange(last_, std::nullopt);
    ++pictures_;
    return times;
  }

 private:
  void keep(const LowFilm& film, const scene::View& view) const {
    const std::lock_guard lock(mutex_);
    last_.emplace(History{film, view});
  }

  Plan plan_;
  std::string settings_;
  double prepare_seconds_;
  int maps_made_;                   // for this frame; others are of frames before
  int pictures_ = 0;                // before this one, by next()
  std::optional<History> history_;  // what they left; any number of renders begins with it
  mutable std::mutex mutex_;
  mutable std::optional<History> last_;  // of the last render, for next()
};

}  // namespace

std::string HalfResolutionMarch::about() const {
  return "engine fog: jittered march at half resolution, bilateral blur, upsampling by depth "
         "(reference/half_resolution_march/README.md)";
}

std::vector<scene::SettingSpec> HalfResolutionMarch::settings() const { return option_specs(); }

std::vector<std::string> HalfResolutionMarch::supports(const scene::Scene& scene,
                                                       const scene::Settings& settings) const {
  return unsupported(scene, read_options(settings));
}

std::unique_ptr<scene::Prepared> HalfResolutionMarch::prepare_supported(std::shared_ptr<const scene::Scene> scene,
                                                                        const scene::Settings& settings,
                                                                        const scene::Execution& execution) const {
  scene::Stopwatch watch;
  Plan plan = make_plan(std::move(scene), read_options(settings), execution);
  const double seconds = watch.lap();
  return std::make_unique<PreparedHalfResolutionMarch>(std::move(plan), settings.canonical(), seconds);
}

}  // namespace airlight::half_resolution_march
