#include "gpu/compensated_ray_marching/map_projection.h"

#include <cmath>

#include "scene/light/map_projection.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

constexpr int projection_lanes = 64;  // invocations of a work group

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
  row_weights_ = std::make_unique<Buffer>(context_, "weights of rows", scene::row_weights(order_, width, height));
  const auto bytes = 8 * 6 * std::size_t(order_);
  fourier_ = std::make_unique<Buffer>(context_, "Fourier sums", bytes * std::size_t(height), Contents::undefined);
  projected_ = std::make_unique<Buffer>(context_, "projected map", 8 * 6 * std::size_t(scene::pair_count(order_)),
                                        Contents::undefined);
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
  bands_.dispatch(projection_lanes * scene::pair_count(order_));

  return project_environment(scene::about_pole(order_, projected_->download<double>()), order_);
}

}  // namespace airlight::gpu::compensated_ray_marching
