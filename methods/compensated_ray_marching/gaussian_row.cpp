#include "methods/compensated_ray_marching/gaussian_row.h"

#include <algorithm>
#include <cmath>

namespace airlight::compensated_ray_marching {
namespace {

constexpr double nothing_beyond_in_row = 6;  // widths: 2e-16 of the amplitude

}  // namespace

GaussianRow::GaussianRow(const scene::GaussianSum& sum, const std::vector<Rgb>* values, const Point3& point,
                         const Vec3& normal)
    : near_(sum), cut2_(std::pow(std::min(sum.cutoff, nothing_beyond_in_row), 2)) {
  near_.gaussians.clear();
  for (std::size_t i = 0; i < sum.gaussians.size(); ++i) {
    const scene::Gaussian& g = sum.gaussians[i];
    const double away = normal.dot(g.center - point) / g.width;
    if (!(away * away < cut2_) || g.amplitude == 0) continue;
    near_.gaussians.push_back(g);
    if (values) values_.push_back((*values)[i]);
  }
}

// Equal steps along a Gaussian: each value is the one before times a factor that itself shrinks by the same factor every step.
long GaussianRow::add(const Ray& ray, const RaySlices& slices, double* density, Rgb* weighted) const {
  long samples = 0;
  for (std::size_t i = 0; i < near_.gaussians.size(); ++i) {
    const scene::Gaussian& g = near_.gaussians[i];
    const Vec3 offset = g.center - ray.origin;
    const double along = offset.dot(ray.direction), square = g.width * g.width;
    const double aside = std::max(0.0, offset.squaredNorm() - along * along) / square;
    if (!(aside < cut2_)) continue;
    const double half = std::sqrt((cut2_ - aside) * square), place = (along - slices.start) / slices.step - 0.5;
    const int first = int(std::max(std::ceil(place - half / slices.step), 0.0));
    const int last = int(std::min(std::floor(place + half / slices.step), double(slices.count - 1)));
    if (first > last) continue;
    const double step = slices.step / g.width, from = (first - place) * step;
    double value = g.amplitude * std::exp(-(aside + from * from)), factor = std::exp(-step * (2 * from + step));
    const double shrink = std::exp(-2 * step * step);
    for (int k = first; k <= last; ++k) {
      density[k] += value;
      if (weighted) weighted[k] += value * values_[i];
      value *= factor;
      factor *= shrink;
    }
    samples += last - first + 1;
  }
  return samples;
}

}  // namespace airlight::compensated_ray_marching
