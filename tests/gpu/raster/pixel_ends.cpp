#include "tests/gpu/raster/pixel_ends.h"

#include <algorithm>
#include <cmath>

#include "scene/geometry/ray_primitive.h"

namespace airlight::gpu::test {
namespace {

// Where a ray meets a triangle's plane, if that is what the device has met. At a silhouette a pixel may show a triangle
// that its ray misses by 1/256 pixel: the device then ends the ray within the triangle's reach, and its word stands.
scene::Hit meet(const scene::TriangleMesh& mesh, int triangle, double distance, const Ray& ray) {
  const auto& corners = mesh.triangles[triangle];
  const Point3& a = mesh.vertices[corners[0]];
  Vec3 normal = scene::accurate_cross(mesh.vertices[corners[1]] - a, mesh.vertices[corners[2]] - a).stableNormalized();
  const double speed = normal.dot(ray.direction), t = normal.dot(a - ray.origin) / speed;
  if (speed > 0) normal = -normal;
  const double taken = std::abs(t - distance) <= 1e-6 * distance ? t : distance;
  return {taken, ray.at(taken), normal, 0, triangle};
}

}  // namespace

PixelEnds::PixelEnds(const scene::Scene& scene) : scene_(scene) {
  for (int s = 0; s < int(scene.surfaces.size()); ++s)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&scene.surfaces[s].shape)) {
      mesh_.push_back(s);
      first_triangle_.push_back(triangles_);
      triangles_ += int(mesh->triangles.size());
    } else {
      solid_.push_back(s);
    }
}

scene::RayEnd PixelEnds::at(int primitive, float distance, const Ray& ray) const {
  if (primitive < 0) return {};
  if (primitive < triangles_) {
    const auto next = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), primitive);
    const std::size_t i = std::size_t(next - first_triangle_.begin()) - 1;
    const auto& mesh = std::get<scene::TriangleMesh>(scene_.surfaces[mesh_[i]].shape);
    scene::Hit hit = meet(mesh, primitive - first_triangle_[i], distance, ray);
    hit.surface = mesh_[i];
    return {hit.t, hit, false, {}};
  }
  const std::size_t solid = std::size_t(primitive - triangles_);
  if (solid >= solid_.size()) return {distance, std::nullopt, true, {}};
  const scene::Shape& shape = scene_.surfaces[solid_[solid]].shape;
  std::array<scene::Crossing, 2> crossings;
  int count = 0;
  if (const auto* sphere = std::get_if<scene::Sphere>(&shape))
    count = cross_sphere(ray, *sphere, crossings);
  else
    count = cross_plane(ray, std::get<scene::Plane>(shape), crossings[0]);
  if (count == 0) return {};  // a tangent, by the last bit
  const scene::Crossing& met = crossings[0];
  return {met.t, scene::Hit{met.t, met.position, met.normal, solid_[solid], -1}, false, {}};
}

}  // namespace airlight::gpu::test
