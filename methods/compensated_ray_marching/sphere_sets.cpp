#include "methods/compensated_ray_marching/sphere_sets.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "scene/geometry/geometry.h"

namespace airlight::compensated_ray_marching {
namespace {

constexpr int cells_along = 24;
constexpr double least_share =
    0.01;  // of the inside, that a sphere adds: shadows of spheres in one another count twice

struct Cells {
  std::vector<Point3> inside, border;  // middles of cells: inside the mesh; outside, beside one that is inside
  double side = 0;                     // [m]
};

// By the parity of what rays along x cross.
Cells cells_of(const scene::TriangleMesh& mesh) {
  Cells cells;
  Box box;
  for (const Point3& vertex : mesh.vertices) box = unite(box, {vertex, vertex});
  cells.side = box.size().maxCoeff() / cells_along;
  if (!(cells.side > 0)) return cells;
  const scene::Geometry geometry({{"", mesh, {}}});
  std::array<int, 3> n;
  for (int a = 0; a < 3; ++a) n[std::size_t(a)] = int(std::ceil(box.size()[a] / cells.side - 1e-9)) + 2;
  const Point3 corner = box.center() - 0.5 * cells.side * Vec3(n[0], n[1], n[2]);
  const auto middle = [&](int x, int y, int z) {
    return Point3(corner + cells.side * Vec3(x + 0.5, y + 0.5, z + 0.5));
  };
  const auto at = [&](int x, int y, int z) { return (std::size_t(z) * n[1] + y) * n[0] + x; };
  std::vector<char> inside(std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]), 0);
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y) {
      const Point3 start = middle(0, y, z) - cells.side * Vec3::UnitX();
      const std::vector<scene::Hit> hits = geometry.all_hits({start, Vec3::UnitX()});
      if (hits.size() % 2 != 0) continue;  // an open mesh
      for (std::size_t k = 0; k + 1 < hits.size(); k += 2)
        for (int x = 0; x < n[0]; ++x) {
          const double t = (x + 1) * cells.side;
          if (t > hits[k].t && t < hits[k + 1].t) inside[at(x, y, z)] = 1;
        }
    }
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y)
      for (int x = 0; x < n[0]; ++x) {
        if (inside[at(x, y, z)]) {
          cells.inside.push_back(middle(x, y, z));
          continue;
        }
        const auto beside = [&](int i, int j, int k) {
          return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2] && inside[at(i, j, k)];
        };
        if (beside(x - 1, y, z) || beside(x + 1, y, z) || beside(x, y - 1, z) || beside(x, y + 1, z) ||
            beside(x, y, z - 1) || beside(x, y, z + 1))
          cells.border.push_back(middle(x, y, z));
      }
  return cells;
}

}  // namespace

std::vector<scene::Sphere> sphere_set(const scene::TriangleMesh& mesh, int count) {
  const Cells cells = cells_of(mesh);
  const std::size_t points = cells.inside.size();
  std::vector<double> radius(points);  // [m], to the next place outside
  for (std::size_t i = 0; i < points; ++i) {
    double nearest = infinity;
    for (const Point3& outside : cells.border) nearest = std::min(nearest, (outside - cells.inside[i]).squaredNorm());
    radius[i] = std::sqrt(nearest);
  }
  std::vector<char> covered(points, 0);
  const auto gain = [&](std::size_t i) {
    int more = 0;
    for (std::size_t k = 0; k < points; ++k)
      more += !covered[k] && (cells.inside[k] - cells.inside[i]).squaredNorm() <= radius[i] * radius[i];
    return more;
  };
  // Gains only shrink: the first whose gain is still the greatest is taken.
  std::priority_queue<std::pair<int, std::size_t>> best;
  for (std::size_t i = 0; i < points; ++i) best.push({gain(i), points - i});
  std::vector<scene::Sphere> spheres;
  while (int(spheres.size()) < count && !best.empty()) {
    const std::size_t i = points - best.top().second;
    best.pop();
    const int now = gain(i);
    if (now < least_share * double(points)) continue;
    if (!best.empty() && now < best.top().first) {
      best.push({now, points - i});
      continue;
    }
    spheres.push_back({cells.inside[i], radius[i]});
    for (std::size_t k = 0; k < points; ++k)
      covered[k] = covered[k] || (cells.inside[k] - cells.inside[i]).squaredNorm() <= radius[i] * radius[i];
  }
  return spheres;
}

std::vector<Caster> casters_of(const std::vector<scene::Surface>& surfaces, int of_a_mesh) {
  std::vector<Caster> casters;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (const auto* sphere = std::get_if<scene::Sphere>(&surfaces[i].shape)) casters.push_back({*sphere, int(i)});
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surfaces[i].shape); mesh && of_a_mesh > 0)
      for (const scene::Sphere& sphere : sphere_set(*mesh, of_a_mesh)) casters.push_back({sphere, int(i)});
  }
  return casters;
}

}  // namespace airlight::compensated_ray_marching
