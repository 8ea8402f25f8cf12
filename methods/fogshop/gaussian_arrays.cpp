#include "methods/fogshop/gaussian_arrays.h"

#include <algorithm>
#include <cmath>

namespace airlight::fogshop {
namespace {

void append(GaussianArrays& to, const Point3& center, double a, double half_depth, double radius_squared, int index) {
  to.x.push_back(center.x());
  to.y.push_back(center.y());
  to.z.push_back(center.z());
  to.a.push_back(a);
  to.half_depth.push_back(half_depth);
  to.radius_squared.push_back(radius_squared);
  to.index.push_back(index);
}

void pad(GaussianArrays& arrays) {
  arrays.count = int(arrays.x.size());
  while (arrays.x.size() % GaussianArrays::padding != 0) append(arrays, Point3::Zero(), 1, 0, -1, 0);
  if (arrays.has_colours())
    for (auto& channel : arrays.colour) channel.resize(arrays.x.size(), 0.0);
}

}  // namespace

double cull_radius(double a, double c, Cull cull, double threshold) {
  if (!(c > 0)) return 0;
  const double exponent =
      cull == Cull::depth ? std::log(c) + 0.5 * std::log(pi) - std::log(a) - std::log(threshold) : std::log(c) + 9;
  return exponent > 0 ? std::sqrt(exponent) / a : 0;
}

CulledGaussians make_arrays(const std::vector<scene::Gaussian>& gaussians, Cull cull, double threshold,
                            const std::vector<Rgb>& colours) {
  CulledGaussians result;
  double deepest = 0;
  for (const scene::Gaussian& g : gaussians) deepest = std::max(deepest, std::sqrt(pi) * g.amplitude * g.width);
  result.threshold = threshold *= std::min(1.0, deepest);
  for (std::size_t i = 0; i < gaussians.size(); ++i) {
    const scene::Gaussian& g = gaussians[i];
    const double a = 1 / g.width;
    const double radius = cull_radius(a, g.amplitude, cull, threshold);
    if (!(radius > 0)) {
      ++result.dropped;
      continue;
    }
    append(result.arrays, g.center, a, 0.5 * std::sqrt(pi) * g.amplitude / a, radius * radius,
           int(result.arrays.x.size()));
    for (int c = 0; c < 3 && !colours.empty(); ++c) result.arrays.colour[c].push_back(colours[i][c]);
  }
  pad(result.arrays);
  return result;
}

GaussianArrays subset(const GaussianArrays& whole, const std::vector<int>& places) {
  GaussianArrays part;
  for (int i : places) append(part, whole.center(i), whole.a[i], whole.half_depth[i], whole.radius_squared[i], i);
  if (whole.has_colours())
    for (int c = 0; c < 3; ++c)
      for (int i : places) part.colour[c].push_back(whole.colour[c][i]);
  pad(part);
  return part;
}

}  // namespace airlight::fogshop
