#include "experiments/application/flow_pictures.h"

#include <algorithm>

#include "gpu/legendre_fluids/legendre_fluids.h"
#include "gpu/legendre_fluids/light.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/finish_copy.h"
#include "scene/math/legendre.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"

namespace airlight::experiments {
namespace {

const std::string drawn_there = gpu::legendre_fluids::LegendreLight().name();
const auto is_smoke = [](const scene::Medium& m) { return scene::extinguishes(m); };

void require_smoke(const scene::Scene& scene) {
  if (std::none_of(scene.media.begin(), scene.media.end(), is_smoke))
    throw Error(scene.name + ": has no medium that extinguishes, expected one that is to be the flow's");
}

}  // namespace

std::shared_ptr<const scene::Scene> scene_with_smoke(const scene::Scene& scene, const scene::DensityField& field) {
  require_smoke(scene);
  const auto changed = std::make_shared<scene::Scene>(scene);
  std::find_if(changed->media.begin(), changed->media.end(), is_smoke)->field = field;
  scene::finish_copy(*changed);
  return changed;
}

FlowPictures::FlowPictures(const scene::Scene& scene, const scene::Renderer& renderer, const scene::Settings& settings,
                           double exposure, int threads)
    : scene_(scene), renderer_(renderer), settings_(settings), exposure_(exposure) {
  execution_.threads = threads;
  execution_.layers = {"mean"};
  require_smoke(scene);
}

void FlowPictures::prepare(const scene::DensityField& field) {
  const auto scene = scene_with_smoke(scene_, field);
  if (prepared_) {
    renderer_.require_support(*scene, settings_);
    if (prepared_->next(scene, execution_)) return;
  }
  prepared_ = renderer_.prepare(scene, settings_, execution_);
}

void FlowPictures::draw(const scene::Flow& flow, const std::string& png) {
  scene::Stopwatch watch;
  // A density on the device is drawn from there, into a picture that was prepared before: a flow may begin empty.
  if (const auto there = gpu::legendre_fluids::density_on_device(flow);
      there && !prepared_ && renderer_.name() == drawn_there) {
    const int n = there->coefficients;
    prepare(std::make_shared<const scene::LegendreBox>(there->box, scene::TensorShape{n, n, n},
                                                       Eigen::VectorXd::Unit(n * n * n, 0)));
  }
  if (prepared_ && gpu::legendre_fluids::draw_flow(*prepared_, flow))
    ++on_device_;
  else
    prepare(flow.medium());
  write(png);
  seconds_ += watch.lap();
}

void FlowPictures::draw(const scene::DensityField& density, const std::string& png) {
  scene::Stopwatch watch;
  prepare(density);
  write(png);
  seconds_ += watch.lap();
}

void FlowPictures::write(const std::string& png) const {
  const scene::Rendering rendering = prepared_->render(scene::view_of(scene_), execution_);
  scene::write_png(png, rendering.film, "mean", exposure_);
}

}  // namespace airlight::experiments
