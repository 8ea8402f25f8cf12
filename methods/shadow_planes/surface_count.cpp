#include "methods/shadow_planes/surface_count.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace airlight::shadow_planes {

bool hides(const Vec3& c, double radius, const Vec3& y) {
  const double length = y.norm();
  if (!(length > 0)) return false;
  const Vec3 u = y / length;
  const double along = c.dot(u), beside = (c - along * u).norm();
  if (beside >= radius) return false;
  const double half = std::sqrt((radius - beside) * (radius + beside));
  const double near = along - half, far = along + half;
  return (near > 0 && near < length) || (far > 0 && far < length);
}

Occluders::Occluders(std::shared_ptr<const scene::Scene> scene) : scene_(std::move(scene)) {
  for (const scene::Surface& surface : scene_->surfaces)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape)) meshes_.emplace_back(*mesh);
}

SurfaceCount::SurfaceCount(std::shared_ptr<const Occluders> occluders, const Point3& light)
    : occluders_(std::move(occluders)), light_(light) {
  for (const MeshEdges& mesh : occluders_->meshes())
    for (const auto& t : mesh.triangles()) {
      const Vec3 a = mesh.vertices()[t[0]] - light, b = mesh.vertices()[t[1]] - light,
                 c = mesh.vertices()[t[2]] - light;
      const Vec3 normal = (b - a).cross(c - a);
      in_wall_ = in_wall_ || std::abs(normal.dot(a)) <= 1e-9 * normal.norm() * (a.norm() + b.norm() + c.norm());
    }
  for (const scene::Surface& surface : occluders_->scene().surfaces) {
    if (const auto* sphere = std::get_if<scene::Sphere>(&surface.shape)) spheres_.push_back(*sphere);
    if (const auto* plane = std::get_if<scene::Plane>(&surface.shape)) planes_.push_back(*plane);
  }
}

// The same sides as the silhouette's: of a triangle in whose plane the light lies, too.
int SurfaceCount::one_by_one(const Vec3& y) const {
  int sum = 0;
  for (const MeshEdges& mesh : occluders_->meshes())
    for (const auto& t : mesh.triangles()) {
      Vec3 a = mesh.vertices()[t[0]] - light_, b = mesh.vertices()[t[1]] - light_, c = mesh.vertices()[t[2]] - light_;
      if (!(a.dot(b.cross(c)) < 0))
        std::swap(b, c);  // faces the light: the shadow is on the negative side of each edge
      if (!(y.dot(a.cross(b)) < 0 && y.dot(b.cross(c)) < 0 && y.dot(c.cross(a)) < 0)) continue;
      sum += (y - a).dot((b - a).cross(c - a)) < 0;  // beyond its plane
    }
  return sum;
}

int SurfaceCount::at(const Point3& point) const {
  const Vec3 offset = point - light_;
  const double distance = offset.norm();
  if (!occluders_->scene().geometry || !(distance > 0)) return 0;
  int sum = 0;
  if (in_wall_)
    sum += one_by_one(offset);
  else
    for (const scene::Hit& hit : occluders_->scene().geometry->all_hits({light_, offset / distance}, distance))
      sum += hit.triangle >= 0;
  for (const scene::Sphere& sphere : spheres_) sum += hides(sphere.center - light_, sphere.radius, offset) ? 2 : 0;
  for (const scene::Plane& plane : planes_) {
    const double here = plane.normal.dot(light_ - plane.point), there = plane.normal.dot(point - plane.point);
    sum += (here > 0 && there < 0) || (here < 0 && there > 0);
  }
  return sum;
}

}  // namespace airlight::shadow_planes
