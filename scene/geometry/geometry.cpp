#include "scene/geometry/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "scene/base/error.h"
#include "scene/geometry/candidate_tree.h"
#include "scene/geometry/clean_mesh.h"
#include "scene/geometry/ray_primitive.h"

namespace airlight::scene {
namespace {

// A primitive of the tree: a triangle of a mesh with its vertices beside it, or a whole sphere.
struct Primitive {
  int surface;
  int triangle;  // -1 for a sphere
  Point3 a, b, c;
};

Box box_of(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  Box box;
  for (const int v : triangle) box = unite(box, {mesh.vertices[v], mesh.vertices[v]});
  return box;
}

Box box_of(const Sphere& sphere) {
  return {sphere.center.array() - sphere.radius, sphere.center.array() + sphere.radius};
}

void check(const Surface& surface) {
  const auto fail = [&](const std::string& what) { throw Error(fmt::format("surface '{}': {}", surface.name, what)); };
  if (const auto* mesh = std::get_if<TriangleMesh>(&surface.shape)) {
    for (std::size_t i = 0; i < mesh->vertices.size(); ++i)
      if (!mesh->vertices[i].allFinite()) fail(fmt::format("vertex {} is not finite", i));
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i)
      for (const int v : mesh->triangles[i])
        if (v < 0 || std::size_t(v) >= mesh->vertices.size())
          fail(fmt::format("triangle {} has vertex {}, expected 0 to {}", i, v, mesh->vertices.size() - 1));
  } else if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) {
    if (!sphere->center.allFinite() || !(sphere->radius > 0) || !std::isfinite(sphere->radius))
      fail(fmt::format("radius {}, expected a finite sphere with a radius above 0", sphere->radius));
  } else {
    const Plane& plane = std::get<Plane>(surface.shape);
    if (!plane.point.allFinite() || !(std::abs(plane.normal.norm() - 1) < 1e-9))
      fail("expected a finite plane with a unit normal");
  }
}

}  // namespace

struct Geometry::Impl {
  std::vector<Surface> surfaces;
  std::vector<Primitive> primitives;
  std::vector<int> planes;  // surfaces; few, and without bounds: tested one by one, outside the tree
  std::unique_ptr<CandidateTree> tree;
  Box bounds;
  double magnitude = 0;  // the largest coordinate, which sets the size of an ulp [m]

  int cross(const Ray& ray, const ShearedRay& sheared, unsigned index, std::array<Crossing, 2>& crossings) const {
    const Primitive& p = primitives[index];
    if (p.triangle >= 0) return cross_triangle(sheared, p.a, p.b, p.c, crossings[0]);
    return cross_sphere(ray, *std::get_if<Sphere>(&surfaces[p.surface].shape), crossings);
  }

  // Calls found(crossing, surface, primitive) for what lies in (0, tmax), in no order; it returns the new tmax,
  // negative to stop.
  enum class Until { end, found };
  template <Until until, class F>
  void for_each_crossing(const Ray& ray, double tmax, F found) const {
    for (const int index : planes) {
      Crossing crossing;
      if (!cross_plane(ray, *std::get_if<Plane>(&surfaces[index].shape), crossing) || crossing.t >= tmax) continue;
      tmax = found(crossing, index, -1);
      if (tmax < 0) return;
    }
    if (!tree) return;
    struct Visitor final : CandidateVisitor {
      const Impl& impl;
      const Ray& ray;
      const ShearedRay sheared;
      double tmax;
      F& found;
      Visitor(const Impl& i, const Ray& r, double t, F& f) : impl(i), ray(r), sheared(r), tmax(t), found(f) {}
      double visit(unsigned index) override {
        std::array<Crossing, 2> crossings;
        const int count = impl.cross(ray, sheared, index, crossings);
        for (int i = 0; i < count && tmax >= 0; ++i)
          if (crossings[i].t < tmax) tmax = found(crossings[i], impl.primitives[index].surface, int(index));
        return tmax;
      }
    } visitor(*this, ray, tmax, found);
    if constexpr (until == Until::found)
      tree->visit_until(ray, tmax, visitor);
    else
      tree->visit(ray, tmax, visitor);
  }
};

Geometry::Geometry(const std::vector<Surface>& surfaces) : impl_(std::make_unique<Impl>()) {
  for (const Surface& surface : surfaces) check(surface);
  impl_->surfaces = surfaces;
  std::vector<Box> boxes;
  const auto add = [&](const Primitive& primitive, const Box& box) {
    impl_->primitives.push_back(primitive);
    boxes.push_back(box);
    impl_->bounds = unite(impl_->bounds, box);
  };
  for (int s = 0; s < int(surfaces.size()); ++s) {
    const auto& shape = impl_->surfaces[s].shape;
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape)) {
      for (const int t : distinct_triangles(*mesh)) {
        const auto& [a, b, c] = mesh->triangles[t];
        add({s, t, mesh->vertices[a], mesh->vertices[b], mesh->vertices[c]}, box_of(*mesh, mesh->triangles[t]));
      }
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
      add({s, -1, {}, {}, {}}, box_of(*sphere));
    } else {
      impl_->planes.push_back(s);
      impl_->magnitude = std::max(impl_->magnitude, std::get<Plane>(shape).point.cwiseAbs().maxCoeff());
    }
  }
  if (boxes.empty()) return;
  impl_->magnitude =
      std::max({impl_->magnitude, impl_->bounds.lo.cwiseAbs().maxCoeff(), impl_->bounds.hi.cwiseAbs().maxCoeff()});
  impl_->tree = std::make_unique<CandidateTree>(boxes);
}

Geometry::~Geometry() = default;

std::optional<Hit> Geometry::first_hit(const Ray& ray, double tmax) const {
  Crossing nearest;
  int surface = -1, primitive = -1;
  impl_->for_each_crossing<Impl::Until::end>(ray, tmax, [&](const Crossing& crossing, int s, int p) {
    // Where surfaces coincide the first in the list wins, in whatever order the tree brings them.
    if (std::tie(crossing.t, s, p) < std::tie(nearest.t, surface, primitive)) {
      nearest = crossing;
      surface = s;
      primitive = p;
    }
    return nearest.t * (1 + std::numeric_limits<double>::epsilon());  // ties are still to be seen
  });
  if (surface < 0) return std::nullopt;
  return Hit{nearest.t, nearest.position, nearest.normal, surface,
             primitive < 0 ? -1 : impl_->primitives[primitive].triangle};
}

bool Geometry::occluded(const Ray& ray, double tmax) const {
  bool found = false;
  impl_->for_each_crossing<Impl::Until::found>(ray, tmax, [&](const Crossing&, int, int) {
    found = true;
    return -1.0;
  });
  return found;
}

std::vector<Hit> Geometry::all_hits(const Ray& ray, double tmax) const {
  struct Found {
    Hit hit;
    int primitive;
  };
  std::vector<Found> found;
  impl_->for_each_crossing<Impl::Until::end>(ray, tmax, [&](const Crossing& crossing, int s, int p) {
    const int triangle = p < 0 ? -1 : impl_->primitives[p].triangle;
    found.push_back({{crossing.t, crossing.position, crossing.normal, s, triangle}, p});
    return tmax;
  });
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.hit.t, a.hit.surface, a.primitive) < std::tie(b.hit.t, b.hit.surface, b.primitive);
  });
  std::vector<Hit> hits;
  hits.reserve(found.size());
  for (const Found& f : found) hits.push_back(f.hit);
  return hits;
}

// A hit lies on its primitive to a few ulp of the largest coordinate (position and plane distance: under 10 of them);
// 32 is safely beyond (1 is seen to fail, 2 not), and 7e-15 of the scene.
Point3 Geometry::offset_origin(const Point3& position, const Vec3& normal, const Vec3& direction) const {
  const double ulp =
      std::numeric_limits<double>::epsilon() * std::max(impl_->magnitude, position.cwiseAbs().maxCoeff());
  return position + (normal.dot(direction) < 0 ? -32 : 32) * ulp * normal;
}

Box Geometry::bounds() const { return impl_->bounds; }
const std::vector<Surface>& Geometry::surfaces() const { return impl_->surfaces; }

}  // namespace airlight::scene
