// Which parts of a ray a point light reaches: Biri et al. 2006, section 5.1, by counting.
//
// m(X) is the number of surfaces, of either facing, that the open segment from the light to X crosses; X is lit if it
// is 0. The paper's stencil counts pairs of them and needs closed meshes with the light and the camera outside; this
// needs neither. A ray up to its first hit crosses no surface, so there are no caps: along it m changes where it
// crosses the plane of a silhouette edge and the light, behind the edge.
#pragma once
#include <memory>
#include <vector>

#include "methods/shadow_planes/light_from_ray.h"
#include "methods/shadow_planes/surface_count.h"

namespace airlight::shadow_planes {

// Where the number of surfaces between a ray and the light changes.
struct Crossing {
  double x;          // [m] along the ray
  int change;        // > 0 into the shadow
  int edge = -1;     // whose plane it is; -1: a sphere's shadow
  double share = 0;  // where on the plane: behind a + share (b - a) of the edge,
  double times = 1;  // that many times as far from the light
  double order = 0;  // plane_order.h; of edges set by whoever needs it
};

// The box around all media that scatter; infinite where one fills all space.
Box scattering_box(const std::vector<scene::Medium>&);

class ShadowVolumes {
 public:
  // Skips meshes that cannot stand between the light and a point of `air`; points outside of `air` must
  // not be asked for. `before`: the volumes of the previous frame for this light, or null. Meshes that
  // have not moved keep their silhouettes.
  ShadowVolumes(std::shared_ptr<const Occluders>, const Point3& light, const Box& air = everywhere,
                const ShadowVolumes* before = nullptr);

  const Point3& light() const { return light_; }
  const std::vector<SilhouetteEdge>& edges() const { return edges_; }
  const std::vector<int>& all_edges() const { return all_; }  // their numbers
  int silhouettes_made() const { return silhouettes_made_; }  // of meshes, by the constructor

  int count(const Point3& point) const { return count_.at(point); }  // m(X)

  // Appends the crossings of these edges within (0, end). `edges`: indices; a ray that passes the light closer than
  // 1e-12 of its distance crosses none.
  void cross_edges(const Ray&, double end, const std::vector<int>& edges, std::vector<Crossing>&) const;
  // Appends the crossings of all spheres, each as two.
  void cross_spheres(const Ray&, double end, std::vector<Crossing>&) const;

  // Lit parts of the ray within [0, end], end [m] at or before its first hit, possibly infinite. `count` is m of its
  // origin, `edges` those that it may cross; null: all. The crossings are sorted on return.
  struct Interval {
    double begin, end;
  };
  void lit_parts(const Ray&, double end, int count, const std::vector<int>* edges, std::vector<Crossing>& crossings,
                 std::vector<Interval>& lit) const;

 private:
  std::shared_ptr<const Occluders> occluders_;
  SurfaceCount count_;
  Point3 light_;
  struct OfMesh {
    std::shared_ptr<const MeshEdges> mesh;
    std::size_t first, count;  // of its edges
  };
  std::vector<SilhouetteEdge> edges_;
  std::vector<OfMesh> of_meshes_;
  std::vector<int> all_;
  int silhouettes_made_ = 0;
};

}  // namespace airlight::shadow_planes
