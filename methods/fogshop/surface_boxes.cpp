#include "methods/fogshop/surface_boxes.h"

#include <numeric>

#include "scene/base/kinds.h"

namespace airlight::fogshop {

SurfaceBoxes::SurfaceBoxes(const std::vector<scene::Surface>& surfaces) {
  for (const scene::Surface& surface : surfaces)
    scene::match(
        surface.shape,
        [&](const scene::TriangleMesh& mesh) {
          for (const auto& corners : mesh.triangles) {
            Box box;
            for (const int corner : corners) box = unite(box, {mesh.vertices[corner], mesh.vertices[corner]});
            boxes_.push_back(box);
          }
        },
        [&](const scene::Sphere& ball) {
          const Vec3 radius = Vec3::Constant(ball.radius);
          boxes_.push_back({ball.center - radius, ball.center + radius});
        },
        [&](const scene::Plane& plane) { planes_.push_back(plane); });
}

Box SurfaceBoxes::bounds() const {
  if (!planes_.empty()) return {Point3::Constant(-infinity), Point3::Constant(infinity)};
  Box all;
  for (const Box& box : boxes_) all = unite(all, box);
  return all;
}

std::vector<int> SurfaceBoxes::all() const {
  std::vector<int> result(boxes_.size());
  std::iota(result.begin(), result.end(), 0);
  return result;
}

bool SurfaceBoxes::touch(const Box& box, const std::vector<int>& candidates, std::vector<int>& touching) const {
  for (const int i : candidates)
    if (!intersect(box, boxes_[i]).empty()) touching.push_back(i);
  bool met = !touching.empty();
  for (const scene::Plane& plane : planes_)
    met |= std::abs(plane.normal.dot(box.center() - plane.point)) <= 0.5 * plane.normal.cwiseAbs().dot(box.size());
  return met;
}

}  // namespace airlight::fogshop
