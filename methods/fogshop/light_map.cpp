#include "methods/fogshop/light_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace airlight::fogshop {
namespace {

// Octahedral map of the sphere to the square [-1, 1]^2: the lower half is folded over the diagonals.
Eigen::Vector2d fold(double x, double y) {
  return {(1 - std::abs(y)) * (x >= 0 ? 1 : -1), (1 - std::abs(x)) * (y >= 0 ? 1 : -1)};
}

Eigen::Vector2d to_octahedron(const Vec3& w) {
  const double sum = std::abs(w.x()) + std::abs(w.y()) + std::abs(w.z());
  const double x = w.x() / sum, y = w.y() / sum;
  return w.z() >= 0 ? Eigen::Vector2d(x, y) : fold(x, y);
}

Vec3 from_octahedron(double x, double y) {
  const double z = 1 - std::abs(x) - std::abs(y);
  const Eigen::Vector2d q = z >= 0 ? Eigen::Vector2d(x, y) : fold(x, y);
  return Vec3(q.x(), q.y(), z).normalized();
}

}  // namespace

LightMap::LightMap(const GaussianArrays& gaussians, const Point3& light, int directions, int edges, Erf erf,
                   const scene::Execution& execution)
    : light_(light), directions_(directions), edges_(edges) {
  frame(gaussians);
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
      cross(gaussians, {light, direction(column - 1, row - 1), far_}, erf, crossings);
      depths_at(crossings, distance.data(), padded, depth.data(), erf);
      std::copy_n(depth.begin(), edges + 1, &depths_[(std::size_t(row) * side + column) * (edges + 1)]);
      evaluations[row] += double(crossings.count) * (edges + 2);
    }
  });
  evaluations_ = std::accumulate(evaluations.begin(), evaluations.end(), 0.0);
}

void LightMap::frame(const GaussianArrays& gaussians) {
  near_ = gaussians.count > 0 ? infinity : 0;
  Vec3 axis = Vec3::Zero();
  for (int i = 0; i < gaussians.count; ++i) {
    const Vec3 offset = gaussians.center(i) - light_;
    const double distance = offset.norm(), radius = std::sqrt(gaussians.radius_squared[i]);
    near_ = std::max(0.0, std::min(near_, distance - radius));
    far_ = std::max(far_, distance + radius);
    if (distance > 0) axis += offset / distance;
  }
  if (!(near_ > 0) || !(axis.norm() > 0)) return;
  axis.normalize();
  double angle = 0;
  for (int i = 0; i < gaussians.count; ++i) {
    const Vec3 offset = gaussians.center(i) - light_;
    angle = std::max(angle, std::atan2(axis.cross(offset).norm(), axis.dot(offset)) +
                                std::asin(std::sqrt(gaussians.radius_squared[i]) / offset.norm()));
  }
  if (angle > 70 * pi / 180) return;
  tangent_ = std::tan(angle);
  const Vec3 side = axis.unitOrthogonal();
  axes_ << side.transpose(), axis.cross(side).transpose(), axis.transpose();
}

Vec3 LightMap::direction(int i, int j) const {
  if (tangent_ > 0) {
    const double x = 2 * (i + 0.5) / directions_ - 1, y = 2 * (j + 0.5) / directions_ - 1;
    return (axes_.transpose() * Vec3(tangent_ * x, tangent_ * y, 1)).normalized();
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

Eigen::Vector2d LightMap::to_square(const Vec3& w) const {
  if (!(tangent_ > 0)) return to_octahedron(w);
  const Vec3 seen = axes_ * w;
  return seen.z() > 0 ? Eigen::Vector2d(seen.x(), seen.y()) / (tangent_ * seen.z()) : Eigen::Vector2d(2, 2);
}

// Edges grow with the square of the distance from a light inside the medium, where the depth changes fastest per
// solid angle close by; they are even across a medium that the light is outside of.
double LightMap::distance_of(double edge) const {
  const double s = edge / edges_;
  return near_ + (far_ - near_) * (near_ > 0 ? s : s * s);
}

double LightMap::edge_of(double distance) const {
  if (!(far_ > near_)) return 0;
  const double s = std::clamp((distance - near_) / (far_ - near_), 0.0, 1.0);
  return edges_ * (near_ > 0 ? s : std::sqrt(s));
}

double LightMap::depth(const Point3& x) const {
  const Vec3 offset = x - light_;
  const double distance = offset.norm();
  if (!(distance > near_) || far_ == 0) return 0;
  const Eigen::Vector2d p = to_square(offset);
  if (!(p.cwiseAbs().maxCoeff() <= 1)) return 0;  // outside the view: no Gaussian there
  const double u = (p.x() + 1) * 0.5 * directions_ + 0.5, v = (p.y() + 1) * 0.5 * directions_ + 0.5;
  const double e = edge_of(distance);
  const int side = directions_ + 2;
  const int i = std::clamp(int(u), 0, side - 2), j = std::clamp(int(v), 0, side - 2), k = std::min(int(e), edges_ - 1);
  const double fu = u - i, fv = v - j, fe = e - k;
  const std::size_t stride = std::size_t(edges_) + 1, row = stride * side;
  const float* c = &depths_[std::size_t(j) * row + std::size_t(i) * stride + k];
  const auto along = [&](const float* at) { return (1 - fe) * at[0] + fe * at[1]; };
  return (1 - fv) * ((1 - fu) * along(c) + fu * along(c + stride)) +
         fv * ((1 - fu) * along(c + row) + fu * along(c + row + stride));
}

}  // namespace airlight::fogshop
