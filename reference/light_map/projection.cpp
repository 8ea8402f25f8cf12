#include "reference/light_map/projection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::light_map {
namespace {

std::array<Point3, 8> corners(const Box& box) {
  std::array<Point3, 8> all;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) all[i][axis] = (i >> axis & 1 ? box.hi : box.lo)[axis];
  return all;
}

Interval range_along(const Vec3& axis, const Box& box) {
  Interval range;
  for (const Point3& corner : corners(box)) {
    range.lo = std::min(range.lo, axis.dot(corner));
    range.hi = std::max(range.hi, axis.dot(corner));
  }
  return range;
}

// Rows x, y, axis: right-handed, y as close to `up` as it can be.
Mat3 axes_around(const Vec3& axis, const Vec3& up) {
  Mat3 axes;
  const Vec3 y = (up - up.dot(axis) * axis).normalized();
  axes.row(0) = y.cross(axis);
  axes.row(1) = y;
  axes.row(2) = axis;
  return axes;
}

// The world axis that is farthest from `axis`.
Vec3 up_for(const Vec3& axis) {
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return Vec3::Unit(least);
}

// A rectangle of least area around a convex polygon has a side along one of the polygon's; those of the box's shadow
// are its edges.
Projection fit_parallel(const Vec3& propagation, const Box& box) {
  Projection best;
  double least = infinity;
  for (int edge = 0; edge < 3; ++edge) {
    const Vec3 up = Vec3::Unit(edge);
    if (up.cross(propagation).norm() < 1e-3) continue;  // seen as a point
    Projection p;
    p.axes = axes_around(propagation, up);
    for (int i = 0; i < 2; ++i) p.across[i] = range_along(p.axes.row(i), box);
    const double area = p.across[0].length() * p.across[1].length();
    if (area < least) least = area, best = p;
  }
  best.depth = range_along(propagation, box);
  return best;
}

// Directions around an axis by their greatest angle, of which the sine keeps the digits of a small one.
struct Cap {
  Vec3 axis = Vec3::UnitY();
  double cosine = -1, sine = 0;

  // The wider ones are as well the whole sphere.
  bool narrow() const { return cosine > 0.02; }
  // Half the side of the square that a narrow cap takes around the octahedron's vertex: its directions (sin t cos p,
  // sin t sin p, cos t) have |x| / (|x| + |y| + |z|) of at most sin t / (sin t + cos t).
  double reach() const { return sine / (sine + cosine); }
};

Cap cap_around(const Box& box, const Point3& light) {
  Cap cap{(box.center() - light).normalized(), 1, 0};
  for (const Point3& corner : corners(box)) {
    const Vec3 direction = (corner - light).normalized();
    cap.cosine = std::min(cap.cosine, cap.axis.dot(direction));
    cap.sine = std::max(cap.sine, cap.axis.cross(direction).norm());
  }
  return cap;
}

Projection fit_around(const scene::Light& light, const Box& box) {
  Projection p;
  p.kind = Projection::Kind::octahedral;
  p.light = scene::ball(light)->center;
  const Point3 nearest = p.light.cwiseMax(box.lo).cwiseMin(box.hi);
  p.depth = {(nearest - p.light).norm(), 0};
  for (const Point3& corner : corners(box)) p.depth.hi = std::max(p.depth.hi, (corner - p.light).norm());
  Cap cap;
  if (p.depth.lo > 0) cap = cap_around(box, p.light);
  if (const auto* spot = std::get_if<scene::SpotLight>(&light)) {
    const Cap cone{spot->axis, std::cos(spot->outer_angle), std::sin(spot->outer_angle)};
    if (cone.narrow() && cone.cosine > cap.cosine) cap = cone;
  }
  p.axes = axes_around(cap.axis, up_for(cap.axis));
  // A spot without an angle lights nothing: any map will do.
  if (cap.narrow()) p.reach = std::max(cap.reach(), 1e-15);
  return p;
}

// The octahedron's faces that look away from the axis are folded over the edges of the square; the fold is its own
// inverse.
void fold(double& x, double& y) {
  const double folded = std::copysign(1 - std::abs(y), x);
  y = std::copysign(1 - std::abs(x), y);
  x = folded;
}

}  // namespace

Projection fit(const scene::Light& light, const Box& box, int size) {
  Projection p = scene::match(
      light, [&](const scene::PointLight&) { return fit_around(light, box); },
      [&](const scene::SpotLight&) { return fit_around(light, box); },
      [&](const scene::DirectionalLight& sun) { return fit_parallel(-sun.to_light, box); },
      [](const scene::EnvironmentLight&) -> Projection {
        throw Error("light map: an environment has many directions");
      });
  p.size = size;
  return p;
}

Ray texel_ray(const Projection& p, int i, int j) {
  const double x = (i + 0.5) / p.size, y = (j + 0.5) / p.size;
  if (p.kind == Projection::Kind::orthographic) {
    const Vec3 local(p.across[0].lo + x * p.across[0].length(), p.across[1].lo + y * p.across[1].length(), 0);
    return {p.axes.transpose() * local, p.axes.row(2)};
  }
  double u = p.reach * (2 * x - 1), v = p.reach * (2 * y - 1);
  const double w = 1 - std::abs(u) - std::abs(v);
  if (w < 0) fold(u, v);
  return {p.light, (p.axes.transpose() * Vec3(u, v, w)).normalized()};
}

Place place(const Projection& p, const Point3& point) {
  double x, y, depth;
  if (p.kind == Projection::Kind::orthographic) {
    const Vec3 local = p.axes * point;
    x = (local[0] - p.across[0].lo) / p.across[0].length();
    y = (local[1] - p.across[1].lo) / p.across[1].length();
    depth = local[2];
  } else {
    const Vec3 local = p.axes * (point - p.light);
    const double sum = local.cwiseAbs().sum();
    double u = sum > 0 ? local[0] / sum : 0, v = sum > 0 ? local[1] / sum : 0;
    if (local[2] < 0) {
      if (!p.whole_sphere()) return {};
      fold(u, v);
    }
    x = 0.5 + 0.5 * u / p.reach;
    y = 0.5 + 0.5 * v / p.reach;
    depth = local.norm();
  }
  x *= p.size, y *= p.size;
  const Interval inside{-slack, p.size + slack};
  if (!(x >= inside.lo && x <= inside.hi && y >= inside.lo && y <= inside.hi)) return {};
  return {std::clamp(x, 0.0, double(p.size)), std::clamp(y, 0.0, double(p.size)),
          std::clamp((depth - p.depth.lo) / p.depth.length(), 0.0, 1.0)};
}

}  // namespace airlight::light_map
