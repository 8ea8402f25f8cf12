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
    : light_(light), grid_{frame_of(gaussians, light), directions, edges} {
  const int padded = (edges + 1 + GaussianArrays::padding - 1) / GaussianArrays::padding * GaussianArrays::padding;
  std::vector<double> distance(padded);
  for (int k = 0; k < padded; ++k) distance[k] = grid_.distance_of(std::min(k, edges));
  const int side = directions + 2;
  depths_.assign(std::size_t(side) * side * (edges + 1), 0.0f);
  std::vector<double> evaluations(side, 0.0);
  scene::parallel_for(side, execution, [&](int row) {
    Crossings crossings;
    std::vector<double> depth(padded);
    for (int column = 0; column < side; ++column) {
      cross(gaussians, {light, grid_.direction(column - 1, row - 1), grid_.frame.far}, erf, crossings);
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

Vec3 MapGrid::direction(int i, int j) const {
  if (frame.tangent > 0) {
    const double x = 2 * (i + 0.5) / directions - 1, y = 2 * (j + 0.5) / directions - 1;
    return (frame.axes.transpose() * Vec3(frame.tangent * x, frame.tangent * y, 1)).normalized();
  }
  // Beyond an edge of the square lies the same edge, reversed.
  if (i < 0 || i >= directions) {
    i = std::clamp(i, 0, directions - 1);
    j = directions - 1 - j;
  }
  if (j < 0 || j >= directions) {
    j = std::clamp(j, 0, directions - 1);
    i = directions - 1 - i;
  }
  return from_octahedron(2 * (i + 0.5) / directions - 1, 2 * (j + 0.5) / directions - 1);
}

// Edges grow with the square of the distance from a light inside the medium, where the depth changes fastest per
// solid angle close by; they are even across a medium that the light is outside of.
double MapGrid::distance_of(double edge) const {
  const double s = edge / edges;
  return frame.near + (frame.far - frame.near) * (frame.near > 0 ? s : s * s);
}

MapGrid::Place MapGrid::place(const Vec3& direction) const {
  const Vec3 p = frame.axes * direction;
  Eigen::Vector2d q;
  if (frame.tangent > 0) {
    if (!(p.z() > 0)) return {};
    q = p.head<2>() / (frame.tangent * p.z());
    if (q.cwiseAbs().maxCoeff() > 1) return {};
  } else {
    q = p.head<2>() / std::max(p.cwiseAbs().sum(), 1e-300);
    if (p.z() < 0) q = fold(q.x(), q.y());
  }
  const Eigen::Vector2d at = 0.5 * directions * (q.array() + 1) + 0.5;
  const int i = std::clamp(int(at.x()), 0, directions), j = std::clamp(int(at.y()), 0, directions);
  return {true, i, j, at.x() - i, at.y() - j};
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
  map.directions = grid_.directions;
  map.edges = grid_.edges;
  map.near = grid_.frame.near;
  map.far = grid_.frame.far;
  map.tangent = grid_.frame.tangent;
  // The axes turn the ray, not every point of it.
  const Vec3 start = grid_.frame.axes * offset, step = grid_.frame.axes * ray.direction;
  look_up(map, start.data(), step.data(), t, count, depth);
}

}  // namespace airlight::fogshop
