#include "reference/ray_marcher/layer.h"

#include <algorithm>
#include <cmath>

namespace airlight::ray_marcher {

std::vector<Layer> make_layers(const std::vector<scene::Medium>& media) {
  std::vector<Layer> layers;
  for (const scene::Medium& medium : media) {
    Layer layer{&medium, 0, true, scene::Unbounded{}};
    if (const auto* uniform = std::get_if<scene::Homogeneous>(&medium.field)) {
      layer.constant = uniform->density;
      layer.varies = false;
    } else if (const auto* sum = std::get_if<scene::GaussianSum>(&medium.field)) {
      layer.constant = sum->constant;
      layer.varies = !sum->gaussians.empty();
      if (layer.varies) {
        scene::GaussianSum varied = *sum;
        varied.constant = 0;
        layer.varied = support(varied);
      }
    } else {
      const Box box = support(medium.field);
      layer.varies = !box.empty();
      layer.varied = box;
    }
    if ((medium.sigma_t <= 0).all() || (layer.constant == 0 && !layer.varies)) continue;
    layers.push_back(layer);
  }
  return layers;
}

Interval constant_extent(const Layer& layer, const Ray& ray, Interval t) {
  if (layer.constant == 0) return {};
  return clip(layer.medium->region, ray, t);
}

Interval varied_extent(const Layer& layer, const Ray& ray, Interval t) {
  if (!layer.varies) return {};
  const Interval inside = clip(layer.medium->region, ray, t);
  return inside.empty() ? inside : clip(layer.varied, ray, inside);
}

double varied_density(const Layer& layer, const Point3& x) { return density(layer.medium->field, x) - layer.constant; }

int steps_through(Interval extent, int count, double length) {
  if (length <= 0) return count;
  // The cap keeps a tiny step in a huge medium from running for ever.
  return int(std::clamp(std::ceil(extent.length() / length), 1.0, double(1 << 20)));
}

double marched_column(const Layer& layer, const Ray& ray, Interval t, int count, double length, long long& steps) {
  const Interval whole = constant_extent(layer, ray, t);
  double column = whole.empty() ? 0 : layer.constant * whole.length();
  const Interval extent = varied_extent(layer, ray, t);
  if (extent.empty()) return column;
  const int n = steps_through(extent, count, length);
  const double h = extent.length() / n;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += varied_density(layer, ray.at(extent.lo + (i + 0.5) * h));
  steps += n;
  return column + h * sum;
}

}  // namespace airlight::ray_marcher
