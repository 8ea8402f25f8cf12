#include "scene/media/fogmap.h"

#include <algorithm>
#include <cmath>

namespace airlight::scene {
namespace {

struct MapPoint {
  double u, v;
};
MapPoint over(const Fogmap& fog, double x, double z) {
  const double dx = (x - fog.x0) / fog.cell, dz = (z - fog.z0) / fog.cell;
  return {dx * fog.cos_turn - dz * fog.sin_turn, dx * fog.sin_turn + dz * fog.cos_turn};
}

// Where the ray is between the heights.
Interval between(const Ray& ray, Interval heights, Interval t) {
  const double y = ray.origin[1], dy = ray.direction[1];
  if (dy == 0) return y >= heights.lo && y <= heights.hi ? t : Interval{};
  const double a = (heights.lo - y) / dy, b = (heights.hi - y) / dy;
  return intersect(t, {std::min(a, b), std::max(a, b)});
}

}  // namespace

MapLine line_over(const Fogmap& fog, const Ray& ray) {
  const MapPoint start = over(fog, ray.origin[0], ray.origin[2]);
  const double dx = ray.direction[0] / fog.cell, dz = ray.direction[2] / fog.cell;
  return {start.u,
          start.v,
          ray.origin[1],
          dx * fog.cos_turn - dz * fog.sin_turn,
          dx * fog.sin_turn + dz * fog.cos_turn,
          ray.direction[1]};
}

double density(const Fogmap& fog, const Point3& x) {
  const MapPoint p = over(fog, x[0], x[2]);
  const double f = fog.map.at(p.u, p.v);
  return f > 0 ? f * factor_at(fog.profile, x[1]) : 0;
}

Interval density_bounds(const Fogmap& fog, const Box& box) {
  if (box.empty()) return {0, 0};
  double lo[2] = {infinity, infinity}, hi[2] = {-infinity, -infinity};
  for (int corner = 0; corner < 4; ++corner) {
    // Infinite sides times a zero of the rotation are no number: far is far enough.
    const double far = 1e30;
    const double x = std::clamp(corner & 1 ? box.hi[0] : box.lo[0], -far, far);
    const double z = std::clamp(corner & 2 ? box.hi[2] : box.lo[2], -far, far);
    const MapPoint p = over(fog, x, z);
    const double slack = 1e-14 * (std::abs(p.u) + std::abs(p.v) + (std::abs(fog.x0) + std::abs(fog.z0)) / fog.cell);
    lo[0] = std::min(lo[0], p.u - slack);
    hi[0] = std::max(hi[0], p.u + slack);
    lo[1] = std::min(lo[1], p.v - slack);
    hi[1] = std::max(hi[1], p.v + slack);
  }
  const Interval f = fog.map.bounds(lo, hi), h = factor_bounds(fog.profile, {box.lo[1], box.hi[1]});
  return {f.lo * h.lo * (1 - 1e-14), f.hi * h.hi * (1 + 1e-14)};
}

double density_integral(const Fogmap& fog, const Ray& ray, Interval t) {
  return t.empty() ? 0 : integral(fog.map, fog.profile, line_over(fog, ray), t);
}

Interval extent(const Fogmap& fog, const Ray& ray, Interval t) {
  return between(ray, occupied_heights(fog.profile), clip(fog.map, line_over(fog, ray), t));
}

std::vector<std::pair<double, double>> ground_corners(const Fogmap& fog) {
  std::vector<std::pair<double, double>> corners;
  for (int corner = 0; corner < 4 && !fog.map.empty(); ++corner) {
    const double u = corner & 1 ? fog.map.support_hi(0) : fog.map.support_lo(0);
    const double v = corner & 2 ? fog.map.support_hi(1) : fog.map.support_lo(1);
    corners.emplace_back(fog.x0 + fog.cell * (u * fog.cos_turn + v * fog.sin_turn),
                         fog.z0 + fog.cell * (v * fog.cos_turn - u * fog.sin_turn));
  }
  return corners;
}

Box support(const Fogmap& fog) {
  Box box;
  const Interval heights = occupied_heights(fog.profile);
  if (!(heights.lo < heights.hi)) return box;
  for (const auto& [x, z] : ground_corners(fog)) box = unite(box, {Point3(x, heights.lo, z), Point3(x, heights.hi, z)});
  for (const int a : {0, 2}) {
    const double slack = 1e-14 * (std::abs(box.lo[a]) + std::abs(box.hi[a]));
    box.lo[a] -= slack;
    box.hi[a] += slack;
  }
  return box;
}

std::vector<double> smooth_between(const Fogmap& fog, const Ray& ray, Interval t) {
  const MapLine line = line_over(fog, ray);
  std::vector<double> cuts;
  walk_cells(fog.map, line, t, [&](int, int, double from, double to) {
    cuts.push_back(from);
    cuts.push_back(to);
    return false;
  });
  for (const double height : height_breaks(fog.profile))
    if (line.dy != 0) cuts.push_back((height - line.y) / line.dy);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::remove_if(cuts.begin(), cuts.end(), [&](double cut) { return !(cut > t.lo && cut < t.hi); }),
             cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

}  // namespace airlight::scene
