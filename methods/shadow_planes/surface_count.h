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
  // `before`, of the last frame or null: meshes of the same number that have not moved keep their edges.
  explicit Occluders(std::shared_ptr<const scene::Scene>, const Occluders* before = nullptr);

  const scene::Scene& scene() const { return *scene_; }
  const std::vector<std::shared_ptr<const MeshEdges>>& meshes() const { return meshes_; }
  int surface(std::size_t mesh) const { return surfaces_[mesh]; }  // which it is of the scene's

 private:
  std::shared_ptr<const scene::Scene> scene_;
  std::vector<std::shared_ptr<const MeshEdges>> meshes_;
  std::vector<int> surfaces_;
};

inline const Box everywhere = {Point3::Constant(-infinity), Point3::Constant(infinity)};

// May one of the surfaces stand between the light and a place in `air`?
bool any_may_shadow(const std::vector<scene::Surface>&, const Point3& light, const Box& air);

class SurfaceCount {
 public:
  // Meshes that cannot stand between the light and a place in `air` do not count, and places outside are not asked for.
  SurfaceCount(std::shared_ptr<const Occluders>, const Point3& light, const Box& air = everywhere);

  const std::vector<std::size_t>& meshes() const { return meshes_; }  // the occluders' numbers of those that count

  // m(X), the number of surfaces, of either facing, that the open segment from the light to X crosses. Spheres count
  // twice for all points that they hide. A light that lies on a triangle is before it (faces_light), on a
  // sphere it is outside, on an infinite plane it shines to both sides, and exactly at a vertex through the triangles
  // there.
  int at(const Point3&) const;

  const std::vector<scene::Sphere>& spheres() const { return spheres_; }

 private:
  // A triangle in whose plane the light lies: rays from there may or may not meet it.
  struct Wall {
    int surface, triangle;
    std::array<int, 3> numbers;   // of its vertices
    std::array<Vec3, 3> corners;  // from the light [m]
  };
  bool is_wall(const scene::Hit&) const;
  bool is_behind(const Wall&, const Vec3& from_light) const;

  std::shared_ptr<const Occluders> occluders_;
  Point3 light_;
  std::vector<std::size_t> meshes_;
  std::vector<char> counts_;  // by surface of the scene: a mesh that counts
  std::vector<Wall> walls_;   // by surface and triangle
  std::vector<scene::Sphere> spheres_;
  std::vector<scene::Plane> planes_;
};

// Does the open segment from the origin to y meet the sphere around c?
bool hides(const Vec3& c, double radius, const Vec3& y);

}  // namespace airlight::shadow_planes
