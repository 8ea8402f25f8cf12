#include "scene/media/region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/base/kinds.h"

namespace airlight::scene {
namespace {

// The part of t where lo <= origin + t * direction <= hi. A ray that runs within a face belongs to the closed set.
Interval clip_axis(double origin, double direction, double lo, double hi, Interval t) {
  if (direction == 0) return origin >= lo && origin <= hi ? t : Interval{};
  const double a = (lo - origin) / direction;
  const double b = (hi - origin) / direction;
  return intersect(t, {std::min(a, b), std::max(a, b)});
}

Interval clip_to(const Unbounded&, const Ray&, Interval t) { return t; }

Interval clip_to(const Box& box, const Ray& ray, Interval t) {
  for (int axis = 0; axis < 3; ++axis)
    t = clip_axis(ray.origin[axis], ray.direction[axis], box.lo[axis], box.hi[axis], t);
  return t;
}

Interval clip_to(const Sphere& sphere, const Ray& ray, Interval t) {
  const Vec3 to_center = sphere.center - ray.origin;
  const double middle = to_center.dot(ray.direction);
  // Distance of the ray's line from the centre by a cross product: |c|^2 - m^2 cancels far away.
  const double reach2 = sphere.radius * sphere.radius - ray.direction.cross(to_center).squaredNorm();
  if (!(reach2 > 0)) return {};
  const double reach = std::sqrt(reach2);
  return intersect(t, {middle - reach, middle + reach});
}

Interval clip_to(const Slab& slab, const Ray& ray, Interval t) {
  return clip_axis(ray.origin.dot(slab.normal), ray.direction.dot(slab.normal), slab.lo, slab.hi, t);
}

bool inside(const Unbounded&, const Point3&) { return true; }
bool inside(const Box& box, const Point3& x) { return box.contains(x); }
bool inside(const Sphere& sphere, const Point3& x) {
  return (x - sphere.center).squaredNorm() <= sphere.radius * sphere.radius;
}
bool inside(const Slab& slab, const Point3& x) {
  const double height = x.dot(slab.normal);
  return height >= slab.lo && height <= slab.hi;
}

Box box_around(const Unbounded&) { return {Point3::Constant(-infinity), Point3::Constant(infinity)}; }
Box box_around(const Box& box) { return box; }
Box box_around(const Sphere& sphere) {
  // Outwards by the rounding of `inside`.
  const double radius = sphere.radius * (1 + 1e-15);
  const Vec3 slack = 1e-15 * sphere.center.cwiseAbs();
  return {sphere.center - Point3::Constant(radius) - slack, sphere.center + Point3::Constant(radius) + slack};
}
Box box_around(const Slab& slab) {
  Box box = box_around(Unbounded{});
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(slab.normal[axis]) != 1) continue;
    const double sign = slab.normal[axis];
    box.lo[axis] = sign > 0 ? slab.lo : -slab.hi;
    box.hi[axis] = sign > 0 ? slab.hi : -slab.lo;
  }
  return box;
}

}  // namespace

Interval clip(const Region& region, const Ray& ray, Interval t) {
  const Interval part = std::visit([&](const auto& shape) { return clip_to(shape, ray, t); }, region);
  return part.empty() ? Interval{} : part;
}

bool contains(const Region& region, const Point3& x) {
  return std::visit([&](const auto& shape) { return inside(shape, x); }, region);
}

Box bounding_box(const Region& region) {
  return std::visit([](const auto& shape) { return box_around(shape); }, region);
}

std::string region_name(const Region& region) {
  return match(
      region, [](const Unbounded&) { return "unbounded"; }, [](const Box&) { return "box"; },
      [](const Sphere&) { return "sphere"; }, [](const Slab&) { return "slab"; });
}

}  // namespace airlight::scene
