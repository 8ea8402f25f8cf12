#include "methods/compensated_ray_marching/marched_smoke.h"

#include <algorithm>
#include <limits>

#include "scene/media/fitted.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double least_source_share = 1e-10;  // of the greatest amplitude: below it no one knows the source

}  // namespace

SmokeField::SmokeField(const scene::Medium& medium, const Options& options) : given_(&medium) {
  const bool paper = options.variant == Options::Variant::paper;
  const auto* fitted = std::get_if<scene::FittedPointer>(&medium.field);
  if (fitted && (paper || !options.residual)) {
    own_ = medium;
    own_->field = (*fitted)->gaussians;
    own_->region = scene::Unbounded{};
    if (options.residual && (*fitted)->residual) {
      const std::vector<std::int8_t> levels = levels_of((*fitted)->residual->bricks);
      if (std::any_of(levels.begin(), levels.end(), [](std::int8_t level) { return level != 0; }))
        residual_.emplace(*(*fitted)->residual, options.paper.store);
    }
  }
  const auto empty = [](const scene::Gaussian& g) { return g.amplitude == 0; };
  if (const auto* all = std::get_if<scene::GaussianSum>(&this->medium().field);
      paper && all && std::any_of(all->gaussians.begin(), all->gaussians.end(), empty)) {
    if (!own_) own_ = medium;
    std::vector<scene::Gaussian>& kept = std::get<scene::GaussianSum>(own_->field).gaussians;
    kept.erase(std::remove_if(kept.begin(), kept.end(), empty), kept.end());
  }
  const auto* sum = std::get_if<scene::GaussianSum>(&this->medium().field);
  if (sum && std::holds_alternative<scene::Unbounded>(this->medium().region)) gaussians_ = sum;
  if (!gaussians_) return;
  for (const scene::Gaussian& g : gaussians_->gaussians)
    least_density_ = std::max(least_density_, least_source_share * g.amplitude);
  least_density_ = std::max(least_density_, double(std::numeric_limits<float>::min()));
}

Interval SmokeField::extent(const Ray& ray, Interval t) const { return scene::extent(medium(), ray, t); }

double SmokeField::density(const Point3& x, double of_gaussians) const {
  if (!gaussians_) return scene::density(medium(), x);
  if (!residual_) return std::max(0.0, of_gaussians);
  return of_gaussians < least_density_ ? 0 : std::max(0.0, of_gaussians + residual_->at(x));
}

}  // namespace airlight::compensated_ray_marching
