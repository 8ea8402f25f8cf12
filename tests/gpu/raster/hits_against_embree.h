// Every pixel of the first hits against scene::ray_end.
#pragma once
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/raster/first_hits.h"
#include "scene/scene.h"
#include "tests/gpu/raster/pixel_ends.h"

namespace airlight::gpu::test {

struct PixelHit {
  float distance;
  float normal[3];
};

struct Agreement {
  int pixels = 0, hits = 0;
  int moved = 0;           // agree with a ray within 1/32 pixel of the centre instead: silhouettes, and
                           // slivers right behind them
  int wrong = 0;           // neither
  std::string first;       // of the wrong
  double distance = 0;     // greatest relative error of the others
  double distance_99 = 0;  // 99th percentile
  double normal = 0;       // greatest difference
};

inline int kind_of(const scene::RayEnd& end) { return end.hit ? end.hit->surface : end.on_ball ? -2 : -1; }

// Does the pixel show what this ray shows? The distance is that of the centre's ray on the same plane, or, where they
// graze it, between the two.
inline bool shows(const PixelHit& pixel, int surface, const Ray& centre, const scene::RayEnd& end) {
  if (kind_of(end) != surface) return false;
  if (surface == -1) return pixel.distance == far_away;
  if (!end.hit) return std::abs(pixel.distance - end.t) <= 1e-2 * end.t;
  const Vec3 n = end.hit->normal, got(pixel.normal[0], pixel.normal[1], pixel.normal[2]);
  const double t = n.dot(end.hit->position - centre.origin) / n.dot(centre.direction);
  const double least = std::min(t, end.t), most = std::max(t, end.t), rounding = 1e-4 * end.t;
  return (got - n).norm() < 1e-4 && pixel.distance >= least - rounding && pixel.distance <= most + rounding;
}

inline Agreement compare(Context& context, const scene::Scene& scene, const scene::View& view,
                         FirstHits::Way way = FirstHits::Way::tree) {
  const Use use(context);
  const std::size_t pixels = std::size_t(view.width) * view.height;
  const Buffer distances(context, "distances", pixels * 4), primitives(context, "primitives", pixels * 4);
  FirstHits(context, scene, true, way).find(view, distances, &primitives);
  const auto distance = distances.download<float>();
  const auto primitive = primitives.download<int>();
  const PixelEnds ends(scene);
  std::vector<PixelHit> hit(pixels, {far_away, {0, 0, 0}});
  std::vector<int> surface(pixels, -1);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (primitive[i] < 0) continue;
    const int x = int(i) % view.width, y = int(i) / view.width;
    const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
    const scene::RayEnd end = ends.at(primitive[i], distance[i], ray);
    surface[i] = end.hit ? end.hit->surface : -2;
    hit[i].distance = distance[i];
    if (end.hit) Eigen::Map<Eigen::Vector3f>(hit[i].normal) = end.hit->normal.cast<float>();
  }
  Agreement result;
  result.pixels = int(pixels);
  std::vector<double> errors;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t(y) * view.width + x;
      const auto ray = [&](double dx, double dy) {
        return camera_ray(view.camera, x + 0.5 + dx, y + 0.5 + dy, view.width, view.height);
      };
      const Ray centre = ray(0, 0);
      const scene::RayEnd end = ray_end(scene, centre);
      result.hits += kind_of(end) != -1;
      const Vec3 got(hit[i].normal[0], hit[i].normal[1], hit[i].normal[2]);
      const double error = end.t < infinity ? std::abs(hit[i].distance / end.t - 1) : 0;
      const double turned = end.hit ? (got - end.hit->normal).norm() : 0;
      if (kind_of(end) == surface[i] && error < 1e-6 && turned < 1e-6) {
        errors.push_back(error);
        result.distance = std::max(result.distance, error);
        result.normal = std::max(result.normal, turned);
        continue;
      }
      // Beside the centre: what is shown is met by a ray there, and if something hides it, then not everywhere.
      bool met = false, seen = false, edge = false;
      for (int k = 0; k < 128; ++k) {  // many: a triangle seen from its edge is a sliver
        const double angle = 2 * pi * k / 32, r = 1.0 / (32 << k / 32);
        const Ray moved = ray(r * std::cos(angle), r * std::sin(angle));
        const scene::RayEnd there = ray_end(scene, moved);
        seen = seen || shows(hit[i], surface[i], centre, there);
        edge = edge || kind_of(there) != kind_of(end) || std::abs(there.t - end.t) > 1e-4 * end.t;
        if (scene.geometry)
          for (const scene::Hit& any : scene.geometry->all_hits(moved))
            met = met || shows(hit[i], surface[i], centre, {any.t, any, false, {}});
      }
      const bool beside = seen || (met && edge);
      ++(beside ? result.moved : result.wrong);
      if (!beside && result.first.empty())
        result.first = fmt::format("pixel {} {}: surface {} at {}, expected {} at {}, normals differ by {}", x, y,
                                   surface[i], hit[i].distance, kind_of(end), end.t, turned);
    }
  std::sort(errors.begin(), errors.end());
  if (!errors.empty()) result.distance_99 = errors[std::size_t(0.99 * double(errors.size() - 1))];
  return result;
}

}  // namespace airlight::gpu::test
