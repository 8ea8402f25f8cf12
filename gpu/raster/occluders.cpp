#include "gpu/raster/occluders.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace airlight::gpu {
namespace {

constexpr int most_in_leaf = 4;

struct Triangle {
  std::array<Point3, 3> corner;
  Box box() const {
    Box b;
    for (const Point3& p : corner) b = unite(b, {p, p});
    return b;
  }
  Point3 center() const { return (corner[0] + corner[1] + corner[2]) / 3; }
};

class Builder {
 public:
  Builder(const std::vector<Triangle>& triangles, Occluders& out) : triangles_(triangles), out_(out) {
    Box all;
    for (const Triangle& t : triangles) all = unite(all, t.box());
    slack_ = 1e-6 * (all.size().maxCoeff() + all.lo.cwiseAbs().maxCoeff() + all.hi.cwiseAbs().maxCoeff());
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0);
    build(0, int(order_.size()));
  }

 private:
  static std::array<float, 4> corner(const Point3& p, int number = 0) {
    return {float(p[0]), float(p[1]), float(p[2]), std::bit_cast<float>(number)};
  }

  void build(int begin, int end) {
    Box box, centers;
    for (int i = begin; i < end; ++i) {
      const Triangle& t = triangles_[order_[i]];
      box = unite(box, t.box());
      centers = unite(centers, {t.center(), t.center()});
    }
    const std::size_t self = out_.nodes.size();
    OccluderNode node{};
    for (int a = 0; a < 3; ++a) node.lo[a] = float(box.lo[a] - slack_), node.hi[a] = float(box.hi[a] + slack_);
    const bool is_leaf = end - begin <= most_in_leaf;
    if (is_leaf) node.leaf = 8 * begin + (end - begin);
    out_.nodes.push_back(node);
    if (is_leaf) {
      for (int i = begin; i < end; ++i) {
        const auto& c = triangles_[order_[i]].corner;
        out_.triangles.push_back({corner(c[0], order_[i]), corner(c[1]), corner(c[2])});
      }
    } else {
      int axis = 0;
      centers.size().maxCoeff(&axis);
      const int middle = begin + (end - begin) / 2;
      std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                       [&](int a, int b) { return triangles_[a].center()[axis] < triangles_[b].center()[axis]; });
      build(begin, middle);
      out_.nodes[self].leaf = -1 - (4 * int(out_.nodes.size()) + axis);
      build(middle, end);
    }
    out_.nodes[self].behind = int(out_.nodes.size());
  }

  const std::vector<Triangle>& triangles_;
  Occluders& out_;
  double slack_;
  std::vector<int> order_;
};

}  // namespace

Occluders make_occluders(const std::vector<scene::Surface>& surfaces, const Point3& middle) {
  Occluders occluders;
  std::vector<Triangle> triangles;
  const auto float3 = [](const Vec3& v) { return std::array<float, 3>{float(v[0]), float(v[1]), float(v[2])}; };
  for (const scene::Surface& surface : surfaces) {
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape)) {
      for (const auto& t : mesh->triangles)
        triangles.push_back(
            {{mesh->vertices[t[0]] - middle, mesh->vertices[t[1]] - middle, mesh->vertices[t[2]] - middle}});
    } else if (const auto* sphere = std::get_if<scene::Sphere>(&surface.shape)) {
      occluders.solids.push_back({float3(sphere->center - middle), float(sphere->radius), {0, 0, 0}, 0});
    } else {
      const auto& plane = std::get<scene::Plane>(surface.shape);
      // The point of the plane nearest to the middle: the one given may be far away.
      const Vec3 near = plane.normal * plane.normal.dot(plane.point - middle);
      occluders.solids.push_back({float3(near), 0, float3(plane.normal), 0});
    }
  }
  if (!triangles.empty()) Builder(triangles, occluders);
  return occluders;
}

}  // namespace airlight::gpu
