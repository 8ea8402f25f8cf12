#include "methods/fogshop/light_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/fogshop/light_map_lookup.h"

namespace airlight::fogshop {
namespace {

// Octahedral map of the sphere to the square [-1, 1]^2: the lower half is folded over the diagonals.
Eigen::Vector2d fold(double x, double y) {
  return {(1 - std::abs(y)) * (x >= 0 ? 1 : -1), (1 - std::abs(x)) * (y >= 0 ? 1 : -1)};
}

Vec3 from_octahedron(double x, double y) {
  const double z = 1 - std::abs(x) - std::abs(y);
  const Eigen::Vector2d q = z >= 0 ? Eigen::Vector2d(x, y) : fold(x, y);
  return Vec3(q.x(), q.y(), z).normalized();
}

}  // namespace

LightMap::LightMap(const GaussianArrays& gaussians, const Point3& light, int directions, int edges, Erf erf,
                   const scene::Execution& execution)
    : light_(light), directions_(directions), edges_(edges), frame_(frame_of(gaussians, light)) {
  const int padded = (edges + 1 + GaussianArrays::padding - 1) / GaussianArrays::padding * GaussianArrays::padding;
  std::vector<double> distance(padded);
  for (int k = 0; k < padded; ++k) distance[k] = distance_of(std::min(k, edges));
  const int side = directions + 2;
  depths_.assign(std::size_t(side) * side * (edges + 1), 0.0f);
  std::vector<double> evaluations(side, 0.0);
  scene::parallel_rows(side, execution, [&](int row) {
    Crossings crossings;
    std::vector<double> depth(padded);
    for (int column = 0; column < side; ++column) {
      cross(gaussians, {light, direction(column - 1, row - 1), frame_.far}, erf, crossings);
      depths_at(crossings, distance.data(), padded, depth.data(), erf);
      std::copy_n(depth.begin(), edges + 1, &depths_[(std::size_t(row) * side + column) * (edges + 1)]);
      evaluations[row] += double(crossings.count) * (edges + 2);
    }
  });
  evaluations_ = std::accumulate(evaluations.begin(), evaluations.end(), 0.0);
}

MapFrame frame_of(const GaussianArrays& gaussians, const Point3& light) {
  MapFrame frame;
  frame.near = gaussians.count > 0 ? infinity : 0;
  Vec3 axis = Vec3::Zero();
  for (int i = 0; i < gaussians.count; ++i) {
    const Vec3 offset = gaussians.center(i) - light;
    const double distance = offset.norm(), radius = std::sqrt(gaussians.radius_squared[i]);
    frame.near = std::max(0.0, std::min(frame.near, distance - radius));
    frame.far = std::max(frame.far, distance + radius);
    if (distance > 0) axis += offset / distance;
  }
  if (!(frame.near > 0) || !(axis.norm() > 0)) return frame;
  axis.normalize();
  double angle = 0;
  for (int i = 0; i < gaussians.count; ++i) {
    const Vec3 offset = gaussians.center(i) - light;
    angle = std::max(angle, std::atan2(axis.cross(offset).norm(), axis.dot(offset)) +
                                std::asin(std::sqrt(gaussians.radius_squared[i]) / offset.norm()));
  }
  if (angle > 70 * pi / 180) return frame;
  frame.tangent = std::tan(angle);
  const Vec3 side = axis.unitOrthogonal();
  frame.axes << side.transpose(), axis.cross(side).transpose(), axis.transpose();
  return frame;
}

Vec3 LightMap::direction(int i, int j) const {
  if (frame_.tangent > 0) {
    const double x = 2 * (i + 0.5) / directions_ - 1, y = 2 * (j + 0.5) / directions_ - 1;
    return (frame_.axes.transpose() * Vec3(frame_.tangent * x, frame_.tangent * y, 1)).normalized();
  }
  // Beyond an edge of the square lies the same edge, reversed.
  if (i < 0 || i >= directions_) {
    i = std::clamp(i, 0, directions_ - 1);
    j = directions_ - 1 - j;
  }
  if (j < 0 || j >= directions_) {
    j = std::clamp(j, 0, directions_ - 1);
    i = directions_ - 1 - i;
  }
  return from_octahedron(2 * (i + 0.5) / directions_ - 1, 2 * (j + 0.5) / directions_ - 1);
}

// Edges grow with the square of the distance from a light inside the medium, where the depth changes fastest per
// solid angle close by; they are even across a medium that the light is outside of.
double LightMap::distance_of(double edge) const {
  const double s = edge / edges_;
  return frame_.near + (frame_.far - frame_.near) * (frame_.near > 0 ? s : s * s);
}

double LightMap::depth(const Point3& x) const {
  const double t[GaussianArrays::padding] = {};
  double depth[GaussianArrays::padding];
  depths({x, Vec3::UnitX(), 0}, t, GaussianArrays::padding, depth);
  return depth[0];
}

void LightMap::depths(const Line& ray, const double* t, int count, double* depth) const {
  const Vec3 offset = ray.origin - light_;
  MapLookup map;
  map.depths = depths_.data();
  map.directions = directions_;
  map.edges = edges_;
  map.near = frame_.near;
  map.far = frame_.far;
  map.tangent = frame_.tangent;
  // The axes turn the ray, not every point of it.
  const Vec3 start = frame_.axes * offset, step = frame_.axes * ray.direction;
  look_up(map, start.data(), step.data(), t, count, depth);
}

}  // namespace airlight::fogshop
