#include "reference/froxel_fog/froxel_fog.h"

#include <fmt/format.h>

#include <mutex>
#include <optional>
#include <utility>

#include "reference/froxel_fog/doubt.h"
#include "reference/froxel_fog/fit.h"
#include "reference/froxel_fog/frames.h"
#include "reference/froxel_fog/stages.h"
#include "scene/base/error.h"
#include "scene/base/flush_subnormals.h"
#include "scene/base/place_error.h"
#include "scene/base/stopwatch.h"
#include "scene/picture.h"

namespace airlight::froxel_fog {
namespace {

constexpr double most_work = 1e12;  // points and their lights in a picture

// Shares the progress of a picture among its parts.
class Parts {
 public:
  Parts(const scene::Execution& whole, int count) : whole_(whole), count_(count) {}
  scene::Execution next() {
    scene::Execution part = whole_;
    if (whole_.progress)
      part.progress = [progress = whole_.progress, before = double(done_), count = count_](double fraction) {
        return progress((before + fraction) / count);
      };
    ++done_;
    return part;
  }

 private:
  const scene::Execution& whole_;
  int count_, done_ = 0;
};

class PreparedFog final : public scene::Prepared {
 public:
  PreparedFog(std::shared_ptr<const scene::Scene> scene, const scene::Settings& effective,
              const scene::Execution& execution)
      : scene_(std::move(scene)),
        options_(read_options(effective)),
        settings_(effective.canonical()),
        lit_(std::make_unique<lit_media::LitMedia>(scene_, options_.media, execution)) {
    prepare_seconds_ = watch_.lap();
    maps_made_ = lit_->maps_made();
  }

  std::vector<scene::Stage> stages() const override { return describe_stages(lit_->plan(), options_, settings_); }
  std::vector<scene::StageTime> prepare_times() const override {
    std::vector<scene::StageTime> times = {{"prepare", prepare_seconds_ - lit_->map_seconds()}};
    if (lit_->map_seconds() > 0) times.push_back({"light_maps", lit_->map_seconds()});
    return times;
  }

  scene::Rendering render(const scene::View& view, const scene::Execution& execution) const override {
    require_own_camera(*scene_, view);
    scene::Rendering result;
    result.film = scene::Film(view.width, view.height);
    result.film.metadata = {
        {"method", "froxel_fog"}, {"settings", settings_}, {"scene", scene_->name}, {"hash", scene_->hash}};
    scene::Stopwatch watch;
    const auto book = [&](const char* stage) { result.times.push_back({stage, watch.lap()}); };
    Parts parts(execution, options_.frames + 4);
    Interval range = slice_range(options_, {});
    if (range.empty()) {
      range = slice_range(options_, media_depths(lit_->plan(), view, parts.next()));
      book("fit");
    }
    std::optional<Volume> volume;
    Counters counters;
    if (!range.empty() && !lit_->layers().empty()) {
      volume.emplace(cells_of(options_, view.width, view.height), slices_of(options_, range));
      for (int frame = 0; frame < options_.frames; ++frame) {
        const Before before = history_ ? Before{float(options_.history_weight), &*history_}
                                       : Before{history_weight(options_, frame), nullptr};
        counters +=
            inject(*lit_, *scene_, view, jitter(options_.jitter, pictures_ + frame), before, *volume, parts.next());
      }
      if (options_.reproject) keep(*volume, view);
      book("inject");
      if (options_.filter != Filter::none) {
        volume->filter(options_.filter, parts.next());
        book("filter");
      }
      volume->integrate(view, parts.next());
      book("integrate");
    }
    counters += draw(volume, view, parts.next(), result.film);
    book("picture");
    if (volume)
      if (const std::string doubt = doubt_of(*lit_, options_, range, *scene_, view); !doubt.empty())
        result.film.metadata["warning"] = "froxel_fog: " + doubt;
    const double froxels = volume ? count_froxels(options_, view.width, view.height) : 0;
    result.counters = {{"froxels", froxels},
                       {"rays", double(counters.rays)},
                       {"points", double(counters.media.points)},
                       {"look_ups", double(counters.media.look_ups)},
                       {"occlusion_rays", double(counters.media.occlusion_rays)}};
    if (options_.media.self_shadow) result.counters["light_maps_made"] = maps_made_;
    if (options_.reproject) result.counters["reprojected"] = double(counters.reprojected);
    return result;
  }

  // Keeps the layers of media and the maps of lights that still hold. With reproject the last picture becomes the history of the next.
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const scene::Scene> scene,
                                                    const scene::Execution& execution) override;

 private:
  void keep(const Volume& volume, const scene::View& view) const {
    const std::lock_guard lock(mutex_);
    last_.emplace(volume, view);
  }

  // Each pixel looks the volume up where its ray ends, or in the last slice.
  Counters draw(const std::optional<Volume>& volume, const scene::View& view, const scene::Execution& execution,
                scene::Film& film) const {
    const scene::PictureLayers layers(film, {});
    const scene::CameraRays rays(view.camera, view.width, view.height);
    return scene::parallel_sum<Counters>(view.height, execution, [&](int y, Counters& counters) {
      const scene::FlushSubnormals flush;
      counters.rays += view.width;
      for (int x = 0; x < view.width; ++x) {
        const Ray ray = rays(x + 0.5, y + 0.5);
        const scene::RayEnd end = camera_end(*scene_, ray);
        scene::Pixel pixel;
        if (volume) {
          const double u = volume->slices().encode(end.t * depth_per_metre(view.camera, ray));
          const Volume::Seen seen = volume->look_up(x + 0.5, y + 0.5, u);
          pixel.airlight = seen.airlight;
          pixel.transmittance = seen.transmittance;
        }
        if ((pixel.transmittance > 0).any())
          pixel.surface = pixel.transmittance *
                          end_radiance(*scene_, ray, end, lit_->lights(), [&](const scene::Incident&, std::size_t l) {
                            return lit_->transmittance_to_light(l, end.hit->position);
                          });
        layers.put(x, y, pixel);
      }
    });
  }

  scene::Stopwatch watch_;
  std::shared_ptr<const scene::Scene> scene_;
  Options options_;
  std::string settings_;
  std::unique_ptr<const lit_media::LitMedia> lit_;
  double prepare_seconds_ = 0;
  int maps_made_ = 0;               // for this frame; others are of frames before
  int pictures_ = 0;                // before this one, by next()
  std::optional<History> history_;  // what they left; any number of renders begins with it
  mutable std::mutex mutex_;
  mutable std::optional<History> last_;  // of the last render, for next()
};

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& o) {
  std::vector<std::string> reasons = lit_media::unsupported(scene, o.media);
  if (const std::string reason = scene::too_thick(scene, 0.01); !reason.empty()) reasons.push_back(reason);
  if (o.far > 0 && o.near >= o.far)
    reasons.push_back(fmt::format("near = {} is not before far = {}, expected less", o.near, o.far));
  if (o.depth == Distribution::exponential && o.near == 0)
    reasons.push_back("near = 0 with depth = exponential, expected more: the slices' ends are near (far / near)^u");
  double lights = 0;
  for (const scene::Light& light : scene.lights) lights += is_delta(light) ? 1 : o.media.environment_directions;
  const double froxels = count_froxels(o, scene.width, scene.height);
  const double work = froxels * o.frames * double(scene.media.size()) * (1 + lights);
  if (work > most_work)
    reasons.push_back(
        fmt::format("{:.3g} froxels in {} frames, {} media and {:.3g} lights are {:.2g} evaluations, expected at most "
                    "{:.0e}",
                    froxels, o.frames, scene.media.size(), lights, work, most_work));
  return reasons;
}

std::optional<std::vector<scene::StageTime>> PreparedFog::next(std::shared_ptr<const scene::Scene> scene,
                                                               const scene::Execution& execution) {
  const bool same =
      lit_media::fits(lit_->plan(), *scene) && scene->width == scene_->width && scene->height == scene_->height;
  if (!same && !unsupported(*scene, options_).empty()) return std::nullopt;
  watch_.lap();
  std::vector<scene::StageTime> times;
  if (!same) {
    lit_ = std::make_unique<lit_media::LitMedia>(scene, options_.media, execution, lit_.get());
    prepare_seconds_ = watch_.lap();
    times = prepare_times();
  }
  maps_made_ = same ? 0 : lit_->maps_made();
  scene_ = std::move(scene);
  if (!options_.reproject) return times;
  if (last_) history_ = std::exchange(last_, std::nullopt);
  ++pictures_;
  return times;
}

}  // namespace

std::string FroxelFog::about() const {
  return "single scattering on a grid of froxels, the fog of most engines (reference/froxel_fog/README.md)";
}

std::vector<scene::SettingSpec> FroxelFog::settings() const { return option_specs(); }

std::vector<std::string> FroxelFog::supports(const scene::Scene& scene, const scene::Settings& settings) const {
  try {
    return unsupported(scene, read_options(effective_settings(settings)));
  } catch (const Error& unread) {
    return {unread.what()};
  }
}

std::unique_ptr<scene::Prepared> FroxelFog::prepare_supported(std::shared_ptr<const scene::Scene> scene,
                                                              const scene::Settings& settings,
                                                              const scene::Execution& execution) const {
  return std::make_unique<PreparedFog>(std::move(scene), effective_settings(settings), execution);
}

}  // namespace airlight::froxel_fog
