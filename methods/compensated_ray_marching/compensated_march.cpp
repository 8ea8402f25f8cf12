#include "methods/compensated_ray_marching/compensated_march.h"

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/special_functions.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr double least_density = 1e-10;  // of the Gaussians: below it no one knows the source

}  // namespace

Rgb seen(const Rgb& depth, double cosine, SliceWeight weight) {
  if (weight == SliceWeight::exact) return depth * depth.unaryExpr(&mean_exp_minus);
  return weight == SliceWeight::paper ? depth : Rgb(depth * cosine);
}

CompensatedMarch::CompensatedMarch(MarchedSmoke smoke) : smoke_(std::move(smoke)) {
  if (smoke_.source.size() != smoke_.gaussians.gaussians.size())
    throw Error("a march with other numbers of sources and of Gaussians");
}

std::vector<Rgb> CompensatedMarch::sources_towards(const Vec3& viewer) const {
  std::vector<Rgb> sources;
  for (const std::vector<Rgb>& harmonics : smoke_.source) sources.push_back(scene::evaluate_sh(harmonics, viewer));
  return sources;
}

CompensatedMarch::Sample CompensatedMarch::at(const Point3& x, const std::vector<Rgb>& towards_viewer) const {
  double density = 0;
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < towards_viewer.size(); ++i) {
    const scene::Gaussian& g = smoke_.gaussians.gaussians[i];
    const double square = (x - g.center).squaredNorm() / (g.width * g.width);
    if (square > smoke_.gaussians.cutoff * smoke_.gaussians.cutoff) continue;
    const double weight = g.amplitude * std::exp(-square);
    density += weight;
    sum += weight * towards_viewer[i];
  }
  if (!(density >= least_density)) return {0, Rgb::Zero()};
  const Rgb source = (sum / density).max(0);
  if (smoke_.residual) density += scene::density(*smoke_.residual, x);
  return {std::max(0.0, density), source};
}

Marched CompensatedMarch::slices(const Ray& ray, const Slices& slices, SliceWeight weight) const {
  const std::vector<Rgb> sources = sources_towards(-ray.direction);
  const double cosine = std::abs(ray.direction.dot(slices.axis)), step = slices.thickness / cosine;
  Marched marched;
  for (int i = 0; i < slices.count; ++i) {
    const Sample sample = at(ray.at((i + 0.5) * step), sources);
    if (!(sample.density > 0)) continue;
    const Rgb depth = smoke_.extinction * sample.density * step;
    marched.radiance += marched.transmittance * sample.source * seen(depth, cosine, weight);
    marched.transmittance *= (-depth).exp();
  }
  return marched;
}

}  // namespace airlight::compensated_ray_marching
