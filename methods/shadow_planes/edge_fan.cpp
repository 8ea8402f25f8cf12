#include "methods/shadow_planes/edge_fan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "methods/shadow_planes/general_position.h"

namespace airlight::shadow_planes {
FanAxes fan_axes(const scene::Camera& camera, const Point3& light) {
  Vec3 line = camera.kind == scene::Camera::Kind::perspective
                  ? Vec3(origin_in_general_position(camera.position, light) - light)
                  : camera.forward;
  if (!(line.norm() > 0)) line = Vec3::UnitX();  // all rays pass through the light and cross nothing
  line.normalize();
  const Vec3 x = line.unitOrthogonal();
  return {x, line.cross(x)};
}

// Grows with the angle, from 0 to 4, without being it.
double EdgeFan::turn(const Vec3& v) const {
  const double x = v.dot(x_), y = v.dot(y_), sum = std::abs(x) + std::abs(y);
  const double p = sum > 0 ? x / sum : 0;
  return y >= 0 ? 1 - p : 3 + p;
}

EdgeFan::Range EdgeFan::range_of(const SilhouetteEdge& edge) const {
  const double ax = edge.a.dot(x_), ay = edge.a.dot(y_), bx = edge.b.dot(x_), by = edge.b.dot(y_);
  const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, cross = ax * by - ay * bx, dot = ax * bx + ay * by;
  const auto small = [](double across2, const Vec3& v) {
    return !(across2 > least_across * least_across * v.squaredNorm());
  };
  // Through the line, or with an end on it.
  const bool through = dot < 0 && std::abs(cross) <= 1e-9 * std::sqrt(a2 * b2);
  if (through || small(a2, edge.a) || small(b2, edge.b)) return {0, 0, sectors(0) - 1};
  // The short way round.
  double from = turn(edge.a), to = turn(edge.b);
  if (std::abs(to - from) <= 2 ? to < from : to > from) std::swap(from, to);
  if (to < from) to += 4;
  from -= margin;
  to += margin;
  for (int level = levels - 1;; --level) {
    const double scale = 0.25 * sectors(level);
    const int first = int(std::floor(from * scale)), last = int(std::floor(to * scale));
    if (last - first <= 2 || level == 0) return {level, first, std::min(last, first + sectors(level) - 1)};
  }
}

EdgeFan::EdgeFan(const ShadowVolumes& shadows, const scene::Camera& camera)
    : shadows_(shadows), perspective_(camera.kind == scene::Camera::Kind::perspective) {
  const FanAxes axes = fan_axes(camera, shadows.light());
  x_ = axes.x;
  y_ = axes.y;
  std::vector<Range> ranges;
  ranges.reserve(shadows.edges().size());
  starts_.assign(first_sector(levels) + 1, 0);
  const auto each = [](const Range& r, auto&& visit) {
    for (int s = r.first; s <= r.last; ++s) visit(first_sector(r.level) + ((s + sectors(r.level)) % sectors(r.level)));
  };
  for (const SilhouetteEdge& edge : shadows.edges()) {
    ranges.push_back(range_of(edge));
    each(ranges.back(), [&](int sector) { ++starts_[sector + 1]; });
  }
  for (std::size_t s = 1; s < starts_.size(); ++s) starts_[s] += starts_[s - 1];
  edges_.resize(starts_.back());
  std::vector<int> next(starts_.begin(), starts_.end() - 1);
  for (int i = 0; i < int(ranges.size()); ++i) each(ranges[i], [&](int sector) { edges_[next[sector]++] = i; });
}

void EdgeFan::of_ray(const Ray& ray, std::vector<int>& edges) const {
  const Vec3 v = perspective_ ? ray.direction : Vec3(ray.origin - shadows_.light());
  const double x = v.dot(x_), y = v.dot(y_);
  if (!(x * x + y * y > least_across * least_across * v.squaredNorm())) {
    edges = shadows_.all_edges();
    return;
  }
  edges.clear();
  const double at = turn(v);
  for (int level = 0; level < levels; ++level) {
    const int sector = first_sector(level) + std::min(int(at * 0.25 * sectors(level)), sectors(level) - 1);
    edges.insert(edges.end(), edges_.begin() + starts_[sector], edges_.begin() + starts_[sector + 1]);
  }
}

}  // namespace airlight::shadow_planes
