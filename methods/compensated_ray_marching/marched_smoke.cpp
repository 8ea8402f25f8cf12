#include "methods/compensated_ray_marching/marched_smoke.h"

#include <algorithm>
#include <limits>

#include "scene/media/fitted.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double least_source_share = 1e-10;  // of the greatest amplitude: below it no one knows the source

bool holds_anything(const scene::Residual& residual) {
  const std::vector<std::int8_t> levels = levels_of(residual.bricks);
  return std::any_of(levels.begin(), levels.end(), [](std::int8_t level) { return level != 0; });
}

scene::FittedPointer gaussians_alone(const scene::Fitted& fitted) {
  auto alone = std::make_shared<scene::Fitted>();
  alone->gaussians = fitted.gaussians;
  alone->grid = scene::decoded(fitted.grid, fitted.gaussians, {});
  return alone;
}

}  // namespace

SmokeField::SmokeField(const scene::Medium& medium, const Options& options) : given_(&medium) {
  const bool paper = options.variant == Options::Variant::paper;
  if (const auto* fitted = std::get_if<scene::FittedPointer>(&medium.field)) {
    const scene::Residual* residual = options.residual ? (*fitted)->residual.get() : nullptr;
    if (paper && residual && holds_anything(*residual)) residual_.emplace(*residual, options.paper.store);
    if (!options.residual) {
      own_ = medium;
      own_->field = gaussians_alone(**fitted);
    }
    if (paper) {
      voxels_ = grid_of(this->medium().field);
      find_centres((*fitted)->gaussians);
    }
    return;
  }
  const auto* sum = std::get_if<scene::GaussianSum>(&medium.field);
  if (!sum) return;
  if (paper) find_centres(*sum);
  if (std::holds_alternative<scene::Unbounded>(medium.region)) gaussians_ = paper ? &centres_ : sum;
}

void SmokeField::find_centres(const scene::GaussianSum& sum) {
  centres_ = sum;
  centres_.gaussians.clear();
  for (const scene::Gaussian& g : sum.gaussians) {
    if (g.amplitude == 0) continue;
    (contains(medium().region, g.center) ? centres_.gaussians : beyond_).push_back(g);
    least_density_ = std::max(least_density_, least_source_share * g.amplitude);
  }
  least_density_ = std::max(least_density_, double(std::numeric_limits<float>::min()));
}

Interval SmokeField::extent(const Ray& ray, Interval t) const { return scene::extent(medium(), ray, t); }

double SmokeField::density(const Point3& x, double of_gaussians) const {
  return gaussians_ ? std::max(0.0, of_gaussians) : scene::density(medium(), x);
}

}  // namespace airlight::compensated_ray_marching
