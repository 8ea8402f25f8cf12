#include "methods/shadow_planes/surface_count.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace airlight::shadow_planes {
namespace {

// Is the triangle through b and c, seen from the origin, on the negative side of the edge from a to b? Computed the
// same way for both triangles of the edge, so that what passes through it belongs to one of them.
bool is_below(const Vec3& y, const Vec3& a, int number_of_a, const Vec3& b, int number_of_b) {
  return number_of_a < number_of_b ? y.dot(a.cross(b)) < 0 : !(y.dot(b.cross(a)) < 0);
}

Box bounds(const scene::Surface& surface) {
  return scene::match(
      surface.shape,
      [](const scene::TriangleMesh& mesh) {
        Box box;
        for (const Point3& vertex : mesh.vertices) box = unite(box, {vertex, vertex});
        return box;
      },
      [](const scene::Sphere& sphere) { return bounding_box(sphere); },
      [](const scene::Plane&) {
        return Box{Point3::Constant(-infinity), Point3::Constant(infinity)};
      });
}

// May something in `box` stand between the light and a place in `air`? Only within the box around both, and in the cone
// from the light around the ball around `air`.
bool may_shadow(const Box& box, const Point3& light, const Box& air) {
  if (!air.size().allFinite() || !box.size().allFinite()) return true;
  if ((box.hi.array() < air.lo.cwiseMin(light).array()).any() ||
      (box.lo.array() > air.hi.cwiseMax(light).array()).any())
    return false;
  const Vec3 to_air = air.center() - light, to_box = box.center() - light;
  const double of_air = 0.5 * air.size().norm() / to_air.norm(), of_box = 0.5 * box.size().norm() / to_box.norm();
  if (!(of_air < 1) || !(of_box < 1)) return true;
  const double between = std::acos(std::clamp(to_air.normalized().dot(to_box.normalized()), -1.0, 1.0));
  return between <= std::asin(of_air) + std::asin(of_box) + 1e-9;
}

}  // namespace

bool any_may_shadow(const std::vector<scene::Surface>& surfaces, const Point3& light, const Box& air) {
  return std::any_of(surfaces.begin(), surfaces.end(),
                     [&](const scene::Surface& surface) { return may_shadow(bounds(surface), light, air); });
}

bool hides(const Vec3& c, double radius, const Vec3& y) {
  const double length = y.norm();
  if (!(length > 0)) return false;
  const Vec3 u = y / length;
  const double along = c.dot(u), beside = (c - along * u).norm();
  if (beside >= radius) return false;
  const double half = std::sqrt((radius - beside) * (radius + beside));
  const double near = along - half, far = along + half;
  const double least = 1e-12 * radius;  // a light on the sphere is outside
  return far > least && ((near > -least && near < length) || far < length);
}

Occluders::Occluders(std::shared_ptr<const scene::Scene> scene, const Occluders* before) : scene_(std::move(scene)) {
  for (std::size_t i = 0; i < scene_->surfaces.size(); ++i)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&scene_->surfaces[i].shape)) {
      const std::size_t m = meshes_.size();
      const bool known = before && m < before->meshes_.size() && before->surfaces_[m] == int(i);
      const auto* was = known ? std::get_if<scene::TriangleMesh>(&before->scene_->surfaces[i].shape) : nullptr;
      const bool still = was && was->vertices == mesh->vertices && was->triangles == mesh->triangles;
      meshes_.push_back(still ? before->meshes_[m] : std::make_shared<const MeshEdges>(*mesh));
      surfaces_.push_back(int(i));
    }
}

SurfaceCount::SurfaceCount(std::shared_ptr<const Occluders> occluders, const Point3& light, const Box& air)
    : occluders_(std::move(occluders)), light_(light) {
  const std::vector<scene::Surface>& surfaces = occluders_->scene().surfaces;
  counts_.resize(surfaces.size());
  for (std::size_t m = 0; m < occluders_->meshes().size(); ++m) {
    const auto surface = std::size_t(occluders_->surface(m));
    if (!may_shadow(bounds(surfaces[surface]), light, air)) continue;
    meshes_.push_back(m);
    counts_[surface] = true;
    const MeshEdges& mesh = *occluders_->meshes()[m];
    for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
      const auto& t = mesh.triangles()[i];
      const Vec3 a = mesh.vertices()[t[0]] - light, b = mesh.vertices()[t[1]] - light,
                 c = mesh.vertices()[t[2]] - light;
      const Vec3 normal = (b - a).cross(c - a);
      if (std::abs(normal.dot(a)) <= 1e-9 * normal.norm() * (a.norm() + b.norm() + c.norm()))
        walls_.push_back({occluders_->surface(m), mesh.number(i), t, {a, b, c}});
    }
  }
  std::sort(walls_.begin(), walls_.end(), [](const Wall& a, const Wall& b) {
    return std::pair(a.surface, a.triangle) < std::pair(b.surface, b.triangle);
  });
  for (const scene::Surface& surface : occluders_->scene().surfaces) {
    if (const auto* sphere = std::get_if<scene::Sphere>(&surface.shape)) spheres_.push_back(*sphere);
    if (const auto* plane = std::get_if<scene::Plane>(&surface.shape)) planes_.push_back(*plane);
  }
}

bool SurfaceCount::is_wall(const scene::Hit& hit) const {
  const auto found = std::lower_bound(walls_.begin(), walls_.end(), hit, [](const Wall& wall, const scene::Hit& h) {
    return std::pair(wall.surface, wall.triangle) < std::pair(h.surface, h.triangle);
  });
  return found != walls_.end() && found->surface == hit.surface && found->triangle == hit.triangle;
}

// Edges and sides follow the conventions of silhouette().
bool SurfaceCount::is_behind(const Wall& wall, const Vec3& y) const {
  Vec3 a = wall.corners[0], b = wall.corners[1], c = wall.corners[2];
  auto [ia, ib, ic] = wall.numbers;
  if (!faces_light(a, b, c)) {  // turned to face the light: the shadow is on the negative side of each edge
    std::swap(b, c);
    std::swap(ib, ic);
  }
  return is_below(y, a, ia, b, ib) && is_below(y, b, ib, c, ic) && is_below(y, c, ic, a, ia) &&
         (y - a).dot((b - a).cross(c - a)) < 0;
}

int SurfaceCount::at(const Point3& point) const {
  const Vec3 offset = point - light_;
  const double distance = offset.norm();
  if (!occluders_->scene().geometry || !(distance > 0)) return 0;
  int sum = 0;
  for (const scene::Hit& hit : occluders_->scene().geometry->all_hits({light_, offset / distance}, distance))
    sum += hit.triangle >= 0 && counts_[std::size_t(hit.surface)] && !is_wall(hit);
  for (const Wall& wall : walls_) sum += is_behind(wall, offset);
  for (const scene::Sphere& sphere : spheres_) sum += hides(sphere.center - light_, sphere.radius, offset) ? 2 : 0;
  for (const scene::Plane& plane : planes_) {
    const double here = plane.normal.dot(light_ - plane.point), there = plane.normal.dot(point - plane.point);
    sum += (here > 0 && there < 0) || (here < 0 && there > 0);
  }
  return sum;
}

}  // namespace airlight::shadow_planes
