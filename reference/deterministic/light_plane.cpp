#include "reference/deterministic/light_plane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::deterministic {
namespace {

// The parameter at which the line from the light through e, a point of the plane, meets the ray, if it does so beyond
// e.
std::optional<double> project(const LightPlane& plane, const Point3& e) {
  const Vec3 along = plane.directional ? plane.to_light : Vec3(e - plane.light);
  const Vec3 across = plane.plane_normal.cross(along);  // in the plane, perpendicular to the line
  const double slope = across.dot(plane.ray.direction);
  if (slope == 0) return std::nullopt;
  const double t = across.dot(e - plane.ray.origin) / slope;
  const Vec3 beyond = plane.ray.at(t) - e;
  const bool behind = plane.directional ? beyond.dot(along) <= 0 : beyond.dot(along) >= 0;
  return behind && std::isfinite(t) ? std::optional<double>(t) : std::nullopt;
}

void add_box(const LightPlane& plane, const std::array<Point3, 8>& corner, std::vector<double>& t) {
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (const int j = i | (1 << axis); j != i) add_edge(plane, corner[i], corner[j], t);
}

// In the order of `corners`: bit 0 and bit 2 on the ground, bit 1 the height.
std::array<Point3, 8> upright_corners(const std::vector<std::pair<double, double>>& ground, double lo, double hi) {
  std::array<Point3, 8> result;
  for (int i = 0; i < 8; ++i) {
    const auto& [x, z] = ground[(i & 1) | (i >> 1 & 2)];
    result[i] = {x, i & 2 ? hi : lo, z};
  }
  return result;
}

std::array<Point3, 8> corners(const Point3& lo, const Point3& hi) {
  std::array<Point3, 8> corner;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) corner[i][axis] = i & (1 << axis) ? hi[axis] : lo[axis];
  return corner;
}

}  // namespace

LightPlane light_plane(const Ray& ray, const scene::Light& light) {
  LightPlane plane;
  plane.ray = ray;
  const Vec3& r = ray.direction;
  Vec3 across;
  if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) {
    plane.directional = true;
    plane.to_light = sun->to_light;
    across = sun->to_light - sun->to_light.dot(r) * r;
  } else {
    plane.light = scene::ball(light).value().center;
    const Vec3 q = plane.light - ray.origin;
    plane.foot = q.dot(r);
    across = q - plane.foot * r;
  }
  // Twice is enough: the first pass leaves a rounding residue along r that matters when h is tiny.
  const double residue = across.dot(r);
  across -= residue * r;
  const double length = across.norm();
  if (!plane.directional) {
    plane.foot += residue;
    plane.h = length;
  }
  plane.normal_to_ray = length > 0 ? Vec3(across / length) : Vec3(Vec3::Zero());
  plane.plane_normal = r.cross(plane.normal_to_ray);
  return plane;
}

Vec3 LightPlane::towards_light(double t) const {
  if (directional) return to_light;
  const double x = t - foot;
  const double distance = std::hypot(x, h);
  return (h * normal_to_ray - x * ray.direction) / distance;
}

void add_tangents(const LightPlane& plane, const Point3& center, double radius, std::vector<double>& t) {
  if (plane.degenerate()) return;
  const double off = plane.plane_normal.dot(center - plane.ray.origin);
  const double squared = radius * radius - off * off;
  if (squared <= 0) return;
  const double circle = std::sqrt(squared);
  const Point3 c = center - off * plane.plane_normal;
  if (plane.directional) {
    const Vec3 side = plane.plane_normal.cross(plane.to_light);
    for (const double sign : {-1.0, 1.0})
      if (const auto hit = project(plane, c + sign * circle * side)) t.push_back(*hit);
    return;
  }
  const Vec3 to_center = c - plane.light;
  const double distance = to_center.norm();
  if (distance <= circle) return;
  // Touching points: at the angle asin(circle/distance) to either side of the centre.
  const Vec3 axis = to_center / distance;
  const Vec3 side = plane.plane_normal.cross(axis);
  const double sine = circle / distance;
  const double length = std::sqrt((distance - circle) * (distance + circle));
  const double cosine = length / distance;
  for (const double sign : {-1.0, 1.0})
    if (const auto hit = project(plane, plane.light + length * (cosine * axis + sign * sine * side))) t.push_back(*hit);
}

void add_edge(const LightPlane& plane, const Point3& a, const Point3& b, std::vector<double>& t) {
  if (plane.degenerate()) return;
  const double da = plane.plane_normal.dot(a - plane.ray.origin);
  const double db = plane.plane_normal.dot(b - plane.ray.origin);
  if ((da > 0 && db > 0) || (da < 0 && db < 0)) return;
  if (da == db) {  // the edge lies in the plane: its ends are the kinks
    for (const Point3& e : {a, b})
      if (const auto hit = project(plane, e)) t.push_back(*hit);
    return;
  }
  if (const auto hit = project(plane, a + da / (da - db) * (b - a))) t.push_back(*hit);
}

void add_cone(const LightPlane& plane, const scene::SpotLight& spot, std::vector<double>& t) {
  // From the light, the point at x = t - foot lies along x r - h n; its cosine to the axis is that of the cone where
  // (x A - h B)^2 = C^2 (x^2 + h^2).
  const double a = spot.axis.dot(plane.ray.direction), b = spot.axis.dot(plane.normal_to_ray), h = plane.h;
  for (const double angle : {spot.inner_angle, spot.outer_angle}) {
    const double c2 = std::cos(angle) * std::cos(angle);
    const double p = a * a - c2, q = -2 * a * b * h, s = h * h * (b * b - c2);
    const double root = q * q - 4 * p * s;
    if (root < 0) continue;
    const double w = -0.5 * (q + std::copysign(std::sqrt(root), q));
    if (p != 0) t.push_back(plane.foot + w / p);
    if (w != 0) t.push_back(plane.foot + s / w);
  }
}

void add_grid(const LightPlane& plane, const scene::VoxelGrid& grid, std::vector<double>& t) {
  if (grid.size.minCoeff() == 0) return;
  const double margin = grid.clamp_border ? 0.5 : 1;
  auto corner = corners(Point3::Constant(-margin), grid.size.cast<double>() + Vec3::Constant(margin - 1));
  for (Point3& c : corner) c = scene::sample_to_world(grid, c);
  add_box(plane, corner, t);
}

void add_medium(const LightPlane& plane, const scene::Medium& medium, std::vector<double>& t) {
  scene::match(
      medium.region, [](const scene::Unbounded&) {},
      [&](const Box& box) { add_box(plane, corners(box.lo, box.hi), t); },
      [&](const scene::Sphere& sphere) { add_tangents(plane, sphere.center, sphere.radius, t); },
      [](const scene::Slab&) {});
  scene::match(
      medium.field, [](const scene::Homogeneous&) {},
      [&](const scene::GaussianSum& sum) {
        if (!(sum.cutoff < infinity)) return;
        for (const scene::Gaussian& g : sum.gaussians) add_tangents(plane, g.center, sum.cutoff * g.width, t);
      },
      [&](const scene::GridPointer& grid) { add_grid(plane, *grid, t); },
      [&](const scene::FogmapPointer& fog) {
        const Box box = scene::bounding_box(medium);
        if (!box.empty() && std::isfinite(box.lo[1]) && std::isfinite(box.hi[1]))
          add_box(plane, upright_corners(scene::ground_corners(*fog), box.lo[1], box.hi[1]), t);
      },
      [&](const scene::LegendrePointer& series) {
        if (series->greatest() > 0) add_box(plane, corners(series->box().lo, series->box().hi), t);
      },
      [&](const scene::FittedPointer& fitted) { add_grid(plane, fitted->grid, t); });
}

void add_gaussian_shadows(const LightPlane& plane, const GaussianTable& table, double sigma, double skip,
                          std::vector<Feature>& features) {
  if (plane.degenerate()) return;
  const double log_skip = std::log(skip / (2 * sigma));
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Point3 center(table.x[i], table.y[i], table.z[i]);
    const double off = table.inverse_width[i] * plane.plane_normal.dot(center - plane.ray.origin);
    if (table.log_scaled[i] - off * off < log_skip) continue;
    const Point3 c = center - off / table.inverse_width[i] * plane.plane_normal;
    const auto t = project(plane, c);
    if (!t) continue;
    // The shadow widens with the distance from the light, and as it falls on the ray at a slant.
    double width = 1 / table.inverse_width[i];
    const double slant = plane.plane_normal.cross(plane.towards_light(*t)).dot(plane.ray.direction);
    if (!plane.directional)
      width *= (plane.ray.at(*t) - plane.light).norm() / std::max((c - plane.light).norm(), width);
    width /= std::max(std::abs(slant), 1e-6);
    for (const double k : {-2.4, -1.2, 0.0, 1.2, 2.4}) features.push_back({*t + k * width, width});
  }
}

}  // namespace airlight::deterministic
