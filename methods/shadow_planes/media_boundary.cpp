#include "methods/shadow_planes/media_boundary.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace airlight::shadow_planes {

MediaBoundary::MediaBoundary(const scene::Region& region, int cells) : cells_(cells) {
  const auto* sphere = std::get_if<scene::Sphere>(&region);
  centre_ = sphere ? sphere->center : std::get<Box>(region).center();
  half_ = sphere ? Vec3(Vec3::Constant(sphere->radius)) : Vec3(0.5 * std::get<Box>(region).size());
  const int side = cells + 1;
  vertices_.reserve(6 * std::size_t(side) * side);
  triangles_.reserve(12 * std::size_t(cells) * cells);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, first = face * side * side;
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        Vec3 u;
        u[axis] = face % 2 == 0 ? 1 : -1;
        u[(axis + 1) % 3] = 2.0 * i / cells - 1;
        u[(axis + 2) % 3] = 2.0 * j / cells - 1;
        vertices_.push_back(centre_ + half_.cwiseProduct(sphere ? u.normalized() : u));
      }
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        const int at = first + j * side + i;
        triangles_.push_back({at, at + 1, at + side + 1});
        triangles_.push_back({at, at + side + 1, at + side});
      }
  }
}

MediaBoundary::Place MediaBoundary::locate(const Point3& point) const {
  const Vec3 d = point - centre_, u = d.cwiseQuotient(half_);
  int axis;
  const double most = u.cwiseAbs().maxCoeff(&axis);
  const auto along = [&](int k) { return 0.5 * cells_ * (u[(axis + k) % 3] / most + 1); };
  const auto cell = [&](double x) { return std::clamp(int(x), 0, cells_ - 1); };
  const int face = 2 * axis + (u[axis] < 0), i = cell(along(1)), j = cell(along(2));
  const int triangle = 2 * ((face * cells_ + j) * cells_ + i) + (along(2) - j > along(1) - i);
  const auto& t = triangles_[triangle];
  const Vec3 a = vertices_[t[0]] - centre_, b = vertices_[t[1]] - centre_, c = vertices_[t[2]] - centre_;
  const Vec3 weight(d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
  return {triangle, weight / weight.sum()};
}

}  // namespace airlight::shadow_planes
