// variant = paper: source radiance at the centres of the Gaussians, surfaces lit by the environment in bands.
#include <fmt/format.h>

#include "gpu/compensated_ray_marching/centre_sources.h"
#include "gpu/compensated_ray_marching/picture.h"
#include "gpu/compensated_ray_marching/smoke_volume.h"
#include "scene/base/stopwatch.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::EnvironmentBands;
using scene::Execution;
using scene::Scene;
using scene::View;

class PaperPicture final : public Picture {
 public:
  PaperPicture(std::shared_ptr<const Scene> scene, const Options& options, std::string settings, Solution last,
               const Execution& execution)
      : Picture(std::move(scene), options, std::move(settings), std::move(last)), bands_(bands(options_.order)) {
    const Use use(context_);
    StageTimer timer(context_);
    timer.begin("upload");
    begin_march();
    begin_centres(timer, execution);
    append(times_, timer.times());
    append(times_, light(execution));
  }

 private:
  void begin_centres(StageTimer&, const Execution&);

  std::vector<scene::StageTime> light(const Execution&) override;
  bool fits(const Scene&) const override { return true; }
  Solution solution() const override { return centres_->solution(); }
  void find_source(const View&) const override;
  void bind_source(Program&) const override;
  void light_surfaces(const View&) const override;
  std::string single() const override {
    return fmt::format("{} centres, {} bands", centres_->centres(), options_.order);
  }
  std::pair<bool, std::string> multiple() const override;
  std::optional<std::string> volume_pass() const override;
  std::string surfaces_lit() const override {
    return fmt::format("lit by the environment in bands, past {} spheres", centres_->objects());
  }
  void count(std::map<std::string, double>&) const override;

  EnvironmentBands bands_;
  std::unique_ptr<SmokeDensity> centre_density_;  // where there are voxels: the Gaussians
  std::unique_ptr<SmokeVolume> volume_;           // where there are voxels
  std::unique_ptr<CentreSourcesOnDevice> centres_;
};

void PaperPicture::begin_centres(StageTimer& timer, const Execution& execution) {
  static const scene::GaussianSum no_smoke;
  static const scene::Medium clear;
  if (smoke_ && smoke_->voxels()) {
    centre_density_ = std::make_unique<SmokeDensity>(context_, smoke_->centres(), middle_);
    volume_ = std::make_unique<SmokeVolume>(context_, *smoke_);
  }
  centres_ = std::make_unique<CentreSourcesOnDevice>(
      context_, smoke_ ? smoke_->centres() : no_smoke, smoke_ ? smoke_->medium() : clear, scene_->surfaces, scatters_,
      volume_ ? centre_density_.get() : density_.get(), middle_, options_, timer, execution);
  centres_->begin_with(last_);
}

std::vector<scene::StageTime> PaperPicture::light(const Execution& execution) {
  scene::Stopwatch watch;
  const auto light = bands_.of(scene_->lights);
  std::vector<scene::StageTime> times{{"environment", watch.lap()}};
  StageTimer timer(context_);
  centres_->light(light, timer, execution);
  append(times, timer.times());
  return times;
}

std::pair<bool, std::string> PaperPicture::multiple() const {
  if (!scatters_) return {false, ""};
  if (!centres_->single_only().empty()) return {false, centres_->single_only()};
  return {true, fmt::format("{} iterations, residual {:.1g}", centres_->iterations(), centres_->residual())};
}

std::optional<std::string> PaperPicture::volume_pass() const {
  if (!volume_) return std::nullopt;
  const Eigen::Vector3i& size = smoke_->voxels()->size;
  return fmt::format("density and source at {} x {} x {} voxels", size[0], size[1], size[2]);
}

void PaperPicture::find_source(const View& view) const {
  if (scatters_) {
    frame_.timer.begin("towards the camera");
    centres_->towards(view);
  }
  if (volume_) {
    frame_.timer.begin("volume pass");
    volume_->find(centres_->sources());
  }
}

void PaperPicture::bind_source(Program& p) const {
  if (volume_) {
    volume_->values().bind(at::volume);
  } else {
    centres_->sources().bind(at::centre_sources);
    p.set("least_source_density", smoke_->least_density());
  }
}

void PaperPicture::light_surfaces(const View& view) const {
  centres_->light_surfaces(view, surroundings_->surfaces()->surfaces(), of_pixels("primitives", view, 4),
                           of_pixels("lit", view, sizeof(wavelet_fog::LitData)));
}

void PaperPicture::count(std::map<std::string, double>& counters) const {
  counters["iterations"] = centres_->iterations();
  counters["multiple_error"] = centres_->residual();
  counters["negative_share"] = centres_->negative_share();
}

}  // namespace

std::unique_ptr<Picture> prepare_paper_picture(std::shared_ptr<const Scene> scene, const Options& options,
                                               std::string settings, Solution last, const Execution& execution) {
  return std::make_unique<PaperPicture>(std::move(scene), options, std::move(settings), std::move(last), execution);
}

}  // namespace airlight::gpu::compensated_ray_marching
