#include "gpu/compensated_ray_marching/map_projection.h"

#include <algorithm>
#include <cmath>

#include "scene/light/lat_long.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

constexpr int projection_lanes = 64;  // invocations of a work group

int pairs(int order) { return order * (order + 1) / 2; }  // (l, m) with m >= 0, at l (l + 1) / 2 + m

// Integrals over angles theta of a row's hat, linear from centre to centre and level in the caps, times Y_lm at azimuth 0; times what a hat
// of a texel's width along a row leaves of frequency m: by pair, then by row.
std::vector<double> weights_of_rows(int order, int width, int height) {
  const auto n = std::size_t(height);
  std::vector<double> weights(std::size_t(pairs(order)) * n, 0.0);
  const scene::GaussLegendre rule = scene::gauss_legendre(std::min(6 + int(3 * order * pi / height), 64));
  for (int strip = 0; strip <= height; ++strip) {
    const double begin = scene::strip_begin(strip, height), end = scene::strip_begin(strip + 1, height);
    const std::size_t top = std::size_t(std::max(strip - 1, 0)), bottom = std::size_t(std::min(strip, height - 1));
    for (std::size_t j = 0; j < rule.node.size(); ++j) {
      const double y = 0.5 * (1 + rule.node[j]), theta = begin + (end - begin) * y;
      const Vec3 w(std::sin(theta), 0, std::cos(theta));
      const double weight = rule.weight[j] * 0.5 * (end - begin) * w[0];
      const std::vector<double> basis = scene::evaluate_sh(order, w);
      for (int l = 0; l < order; ++l)
        for (int m = 0; m <= l; ++m) {
          double* row = &weights[std::size_t(l * (l + 1) / 2 + m) * n];
          const double value = weight * basis[std::size_t(scene::sh_index(l, m))];
          row[top] += (1 - y) * value;
          row[bottom] += y * value;
        }
    }
  }
  for (int l = 0; l < order; ++l)
    for (int m = 0; m <= l; ++m) {
      const double half = m * pi / width, shrunk = m > 0 ? std::sin(half) / half : 1;
      double* row = &weights[std::size_t(l * (l + 1) / 2 + m) * n];
      for (std::size_t i = 0; i < n; ++i) row[i] *= 2 * pi / width * shrunk * shrunk;
    }
  return weights;
}

}  // namespace

MapProjection::MapProjection(Context& context, int order)
    : context_(context),
      order_(order),
      rows_(program(context, "map_rows", projection_lanes, 1, {})),
      bands_(program(context, "map_bands", projection_lanes, 1, {})) {}

void MapProjection::prepare(int width, int height) {
  if (width == width_ && height == height_) return;
  std::vector<double> circle;  // cosine and sine of multiples of half a texel's angle
  for (int i = 0; i < 2 * width; ++i) {
    circle.push_back(std::cos(pi * i / width));
    circle.push_back(std::sin(pi * i / width));
  }
  circle_ = std::make_unique<Buffer>(context_, "circle of a map", circle);
  row_weights_ = std::make_unique<Buffer>(context_, "weights of rows", weights_of_rows(order_, width, height));
  const auto bytes = 8 * 6 * std::size_t(order_);
  fourier_ = std::make_unique<Buffer>(context_, "Fourier sums", bytes * std::size_t(height), Contents::undefined);
  projected_ =
      std::make_unique<Buffer>(context_, "projected map", 8 * 6 * std::size_t(pairs(order_)), Contents::undefined);
  width_ = width;
  height_ = height;
}

std::vector<Rgb> MapProjection::of(const scene::EnvironmentMap& map, const Buffer& texels) {
  prepare(map.width, map.height);
  texels.bind(at::map_texels);
  circle_->bind(at::circle);
  fourier_->bind(at::fourier);
  rows_.set("width", map.width);
  rows_.set("height", map.height);
  rows_.dispatch(projection_lanes * map.height, order_);
  row_weights_->bind(at::row_weights);
  projected_->bind(at::projected);
  bands_.set("height", map.height);
  bands_.dispatch(projection_lanes * pairs(order_));

  // About the map's pole y, azimuths from +z towards +x: its axes (z, x, y) are those of the harmonics. The rows begin there and turn the
  // other way.
  const std::vector<double> sums = projected_->download<double>();
  scene::EnvironmentLight about_pole;
  about_pole.to_map << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  about_pole.sh.resize(std::size_t(order_ * order_));
  for (int l = 0; l < order_; ++l)
    for (int m = 0; m <= l; ++m)
      for (int c = 0; c < 3; ++c) {
        const double* pair = &sums[6 * std::size_t(l * (l + 1) / 2 + m)];
        about_pole.sh[std::size_t(scene::sh_index(l, m))][c] = pair[c];
        if (m > 0) about_pole.sh[std::size_t(scene::sh_index(l, -m))][c] = -pair[3 + c];
      }
  return project_environment(about_pole, order_);
}

}  // namespace airlight::gpu::compensated_ray_marching
