#include "reference/deterministic/shadow.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace airlight::deterministic {
namespace {

// t in [lo, hi], hi possibly infinite, at the fraction s in (0, 1).
double inside(double lo, double hi, double s) {
  if (std::isinf(hi)) return lo + (1 + std::abs(lo)) * s / (1 - s);
  return lo + s * (hi - lo);
}

}  // namespace

ShadowFinder::ShadowFinder(const scene::Geometry& geometry, int samples) : geometry_(geometry), samples_(samples) {
  for (const scene::Surface& surface : geometry.surfaces()) {
    const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape);
    if (!mesh) continue;
    if (mesh->triangles.size() > std::size_t(exact_triangles)) {
      exact_ = false;
      continue;
    }
    std::set<std::pair<int, int>> edges;
    for (const auto& triangle : mesh->triangles)
      for (int k = 0; k < 3; ++k) edges.insert(std::minmax(triangle[k], triangle[(k + 1) % 3]));
    for (const auto& [a, b] : edges) edges_.push_back({mesh->vertices[a], mesh->vertices[b]});
  }
}

bool ShadowFinder::visible(const LightPlane& plane, double t) const {
  const Point3 x = plane.ray.at(t);
  if (plane.directional) return !geometry_.occluded({x, plane.to_light});
  return !geometry_.occluded({x, plane.towards_light(t)}, std::hypot(t - plane.foot, plane.h));
}

void ShadowFinder::split(const LightPlane& plane, double lo, double hi, bool lo_lit, bool hi_lit,
                         std::vector<std::pair<double, bool>>& states) const {
  while (hi - lo > 1e-14 * (1 + std::abs(hi))) {
    const double middle = 0.5 * (lo + hi);
    if (!(middle > lo && middle < hi)) break;
    (visible(plane, middle) == lo_lit ? lo : hi) = middle;
  }
  states.push_back({0.5 * (lo + hi), hi_lit});
}

std::vector<Interval> ShadowFinder::lit(const LightPlane& plane, Interval range) const {
  std::vector<double> cuts{range.lo, range.hi};
  for (const scene::Surface& surface : geometry_.surfaces())
    if (const auto* sphere = std::get_if<scene::Sphere>(&surface.shape))
      add_tangents(plane, sphere->center, sphere->radius, cuts);
  for (const auto& edge : edges_) add_edge(plane, edge[0], edge[1], cuts);
  // Behind the light the line of sight turns round: whatever hides one side of the foot need not hide the other.
  if (!plane.directional) cuts.push_back(plane.foot);
  cuts.erase(std::remove_if(cuts.begin(), cuts.end(), [&](double t) { return !(t >= range.lo && t <= range.hi); }),
             cuts.end());
  std::sort(cuts.begin(), cuts.end());

  // (from t on, lit): states in order. Within a stretch between exact cuts the middle tells; otherwise many points do.
  std::vector<std::pair<double, bool>> states;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double lo = cuts[i], hi = cuts[i + 1];
    if (!(hi - lo > 1e-13 * (1 + std::abs(lo)))) continue;
    int points = 1;
    if (!exact_) {
      const double share = std::isinf(hi) || std::isinf(range.hi) ? 0.5 : (hi - lo) / range.length();
      points = std::max(3, int(std::ceil(samples_ * share)));
    }
    double before = inside(lo, hi, 0.5 / points);
    bool state = visible(plane, before);
    states.push_back({lo, state});
    for (int k = 1; k < points; ++k) {
      const double t = inside(lo, hi, (k + 0.5) / points);
      const bool now = visible(plane, t);
      if (now != state) split(plane, before, t, state, now, states);
      state = now;
      before = t;
    }
  }
  std::vector<Interval> result;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!states[i].second) continue;
    const double end = i + 1 < states.size() ? states[i + 1].first : range.hi;
    if (!result.empty() && result.back().hi == states[i].first)
      result.back().hi = end;
    else
      result.push_back({states[i].first, end});
  }
  return result;
}

}  // namespace airlight::deterministic
