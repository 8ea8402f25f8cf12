// How many surfaces lie between a point light and a point.
#pragma once
#include <memory>
#include <vector>

#include "methods/shadow_planes/silhouette.h"
#include "scene/scene.h"

namespace airlight::shadow_planes {

// The meshes of a scene by their edges: the same for every light.
class Occluders {
 public:
  explicit Occluders(std::shared_ptr<const scene::Scene>);

  const scene::Scene& scene() const { return *scene_; }
  const std::vector<MeshEdges>& meshes() const { return meshes_; }

 private:
  std::shared_ptr<const scene::Scene> scene_;
  std::vector<MeshEdges> meshes_;
};

class SurfaceCount {
 public:
  SurfaceCount(std::shared_ptr<const Occluders>, const Point3& light);

  // m(X), the number of surfaces, of either facing, that the open segment from the light to X crosses. Spheres count
  // twice for all points that they hide. A light that lies on a triangle shines to one side of it, the one that
  // rounding puts it on.
  int at(const Point3&) const;

  const std::vector<scene::Sphere>& spheres() const { return spheres_; }

 private:
  int one_by_one(const Vec3& from_light) const;

  std::shared_ptr<const Occluders> occluders_;
  Point3 light_;
  bool in_wall_ = false;  // in the plane of a triangle: rays from it may or may not meet that
  std::vector<scene::Sphere> spheres_;
  std::vector<scene::Plane> planes_;
};

// Does the open segment from the origin to y meet the sphere around c?
bool hides(const Vec3& c, double radius, const Vec3& y);

}  // namespace airlight::shadow_planes
