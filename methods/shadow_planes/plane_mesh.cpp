#include "methods/shadow_planes/plane_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::shadow_planes {
namespace {

constexpr int most_vertices = 20'000'000;  // 1.1 GB with their airlight

}  // namespace

PlaneMesh::PlaneMesh(const ShadowVolumes& shadows, const std::vector<char>& left_out, double far, int pieces,
                     int levels)
    : pieces_(pieces), levels_(levels) {
  const double count = double(std::count(left_out.begin(), left_out.end(), false)) * (pieces + 1) * (levels + 2);
  if (count > most_vertices)
    throw Error(fmt::format("shadow planes of {:.0f} vertices, expected at most {}: fewer plane_levels or edge_split",
                            count, most_vertices));
  vertices_.reserve(std::size_t(count));
  for (std::size_t i = 0; i < shadows.edges().size(); ++i) {
    const SilhouetteEdge& edge = shadows.edges()[i];
    const double near = std::max(0.5 * (edge.a + edge.b).norm(), 1e-6 * far);
    rows_.push_back({int(vertices_.size()), std::log(std::max(2.0, far / near)) / levels});
    if (left_out[i]) continue;
    planes_ += pieces;
    for (int k = 0; k <= pieces; ++k) {
      const Vec3 p = edge.a + (edge.b - edge.a) * (double(k) / pieces);
      for (int level = 0; level <= levels; ++level)
        vertices_.push_back({shadows.light() + std::exp(level * rows_.back().ratio) * p});
      vertices_.push_back({p, true});
    }
  }
}

PlaneMesh::Place PlaneMesh::locate(const Crossing& crossing) const {
  const Row& row = rows_[crossing.edge];
  const int piece = std::min(int(crossing.share * pieces_), pieces_ - 1);
  const double u = crossing.share * pieces_ - piece, s = std::max(1.0, crossing.times);
  const int level = std::min(int(std::log(s) / row.ratio), levels_);
  // a: the piece's first end, b: its second; 0: nearer to the light, 1: farther away.
  const int a0 = row.first + piece * (levels_ + 2) + level, a1 = a0 + 1, b0 = a0 + levels_ + 2, b1 = b0 + 1;
  const double s0 = std::exp(level * row.ratio);
  double nearer;      // share of the vertices at s0
  double at_a, at_b;  // of one vertex of its end alone: a0 in the first triangle, b1 in the second
  if (level < levels_) {
    const double s1 = std::exp((level + 1) * row.ratio);
    nearer = (s1 - s) / (s1 - s0);
    at_a = s * (1 - u) / s0;
    at_b = s * u / s1;
  } else {
    nearer = s0 / s;
    at_a = 1 - u;
    at_b = u;
  }
  if (at_a <= nearer) return {{a0, b0, b1}, {at_a, nearer - at_a, 1 - nearer}};
  return {{a0, a1, b1}, {nearer, 1 - nearer - at_b, at_b}};
}

}  // namespace airlight::shadow_planes
