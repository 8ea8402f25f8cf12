#include "methods/fogshop/airlight_pass.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace airlight::fogshop {
namespace {

constexpr int tile_size = 8;

// All rays of a tile: a ray in the middle, and how far others start from it and spread per metre.
struct Bundle {
  Ray axis;
  double width = 0;   // [m]
  double spread = 0;  // |difference of unit directions|, < 1
};

// Corners are film positions.
Bundle bundle_of(const scene::View& view, int x0, int y0, int x1, int y1) {
  Bundle b{camera_ray(view.camera, 0.5 * (x0 + x1), 0.5 * (y0 + y1), view.width, view.height)};
  // The corner rays of the tile are farthest from its middle ray.
  for (int corner = 0; corner < 4; ++corner) {
    const Ray ray = camera_ray(view.camera, corner & 1 ? x1 : x0, corner & 2 ? y1 : y0, view.width, view.height);
    b.width = std::max(b.width, (ray.origin - b.axis.origin).norm());
    b.spread = std::max(b.spread, (ray.direction - b.axis.direction).norm());
  }
  return b;
}

// Does the sphere come within width + spread t of the axis at some t >= 0?
bool touches(const Bundle& bundle, const Point3& center, double radius) {
  const Vec3 q = center - bundle.axis.origin;
  if (bundle.spread >= 1) return true;
  const double m = q.dot(bundle.axis.direction);
  const double p = bundle.axis.direction.cross(q).norm();
  // |q - t axis| - spread t is least where the line to the centre leans back by the angle whose sine is `spread`.
  const double cosine = std::sqrt(1 - bundle.spread * bundle.spread);
  const double least = m + p * bundle.spread / cosine > 0 ? p * cosine - bundle.spread * m : q.norm();
  return least <= radius + bundle.width;
}

// `only` may be null: all.
void compute(const Model& model, const ViewModel& view_model, const scene::View& view,
             const std::vector<double>& distance, int step, const std::vector<unsigned char>* only,
             const scene::Execution& execution, AirlightImage& image) {
  const int width = (view.width + step - 1) / step, height = (view.height + step - 1) / step;
  const int rows = (height + tile_size - 1) / tile_size;
  std::vector<std::array<double, 3>> counts(rows);
  scene::parallel_for(rows, execution, [&](int row) {
    RayAirlight rays(model, view_model);
    const int y0 = row * tile_size, y1 = std::min(height, y0 + tile_size);
    std::vector<int> places;
    double candidates = 0;
    for (int x0 = 0; x0 < width; x0 += tile_size) {
      const int x1 = std::min(width, x0 + tile_size);
      int wanted = (x1 - x0) * (y1 - y0);
      if (only) {
        wanted = 0;
        for (int y = y0; y < y1; ++y)
          for (int x = x0; x < x1; ++x) wanted += (*only)[std::size_t(y) * width + x] != 0;
        if (wanted == 0) continue;
      }
      const Bundle bundle = bundle_of(view, step * x0, step * y0, step * x1, step * y1);
      places.clear();
      for (int i = 0; i < model.gaussians.count; ++i)
        if (touches(bundle, model.gaussians.center(i), std::sqrt(model.gaussians.radius_squared[i])))
          places.push_back(i);
      const GaussianArrays near = subset(model.gaussians, places);
      candidates += double(places.size()) * wanted;
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
          const std::size_t i = std::size_t(y) * width + x;
          if (only && !(*only)[i]) continue;
          const Ray ray = camera_ray(view.camera, step * (x + 0.5), step * (y + 0.5), view.width, view.height);
          rays.evaluate(near, {ray.origin, ray.direction, distance[i]}, image.airlight[i], image.depth[i]);
        }
    }
    counts[row] = {rays.evaluations, rays.crossed, candidates};
  });
  for (const auto& [evaluations, crossed, candidates] : counts) {
    image.evaluations += evaluations;
    image.crossed += crossed;
    image.candidates += candidates;
  }
}

}  // namespace

AirlightImage airlight_pass(const Model& model, const ViewModel& view_model, const scene::View& view,
                            const std::vector<double>& distance, const scene::Execution& execution, int step) {
  AirlightImage image;
  image.airlight.assign(distance.size(), Rgb::Zero());
  image.depth.assign(distance.size(), 0.0);
  compute(model, view_model, view, distance, step, nullptr, execution, image);
  return image;
}

void airlight_again(const Model& model, const ViewModel& view_model, const scene::View& view,
                    const std::vector<double>& distance, const std::vector<unsigned char>& only,
                    const scene::Execution& execution, AirlightImage& image) {
  compute(model, view_model, view, distance, 1, &only, execution, image);
}

}  // namespace airlight::fogshop
