#include "methods/shadow_planes/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "scene/geometry/clean_mesh.h"

namespace airlight::shadow_planes {

MeshEdges::MeshEdges(const scene::TriangleMesh& mesh) {
  std::map<std::array<double, 3>, int> places;
  std::vector<int> place_of;
  for (const Point3& v : mesh.vertices) {
    const auto [found, is_new] = places.try_emplace({v[0], v[1], v[2]}, int(vertices_.size()));
    if (is_new) vertices_.push_back(v);
    place_of.push_back(found->second);
  }
  std::map<std::array<int, 2>, std::vector<Side>> sides;
  for (const int number : scene::distinct_triangles(mesh)) {
    const auto& t = mesh.triangles[number];
    const std::array<int, 3> own = {place_of[t[0]], place_of[t[1]], place_of[t[2]]};
    if (own[0] == own[1] || own[1] == own[2] || own[2] == own[0]) continue;
    const int index = int(triangles_.size());
    triangles_.push_back(own);
    numbers_.push_back(number);
    for (int k = 0; k < 3; ++k) {
      const int a = own[k], b = own[(k + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}].push_back({index, a < b});
    }
  }
  for (const auto& [ends, of_edge] : sides) {
    edges_.push_back({ends[0], ends[1], int(sides_.size()), int(of_edge.size())});
    sides_.insert(sides_.end(), of_edge.begin(), of_edge.end());
  }
}

bool faces_light(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  return normal.dot(a) <=
         4e-15 * std::sqrt(normal.squaredNorm() * (a.squaredNorm() + b.squaredNorm() + c.squaredNorm()));
}

std::vector<SilhouetteEdge> silhouette(const MeshEdges& mesh, const Point3& light) {
  std::vector<Vec3> from_light;
  from_light.reserve(mesh.vertices().size());
  for (const Point3& v : mesh.vertices()) from_light.push_back(v - light);
  std::vector<char> faces;
  faces.reserve(mesh.triangles().size());
  for (const auto& t : mesh.triangles())
    faces.push_back(faces_light(from_light[t[0]], from_light[t[1]], from_light[t[2]]));
  std::vector<SilhouetteEdge> result;
  for (const MeshEdges::Edge& edge : mesh.edges()) {
    int sum = 0;
    for (int k = edge.first; k < edge.first + edge.count; ++k) {
      const MeshEdges::Side& side = mesh.sides()[k];
      sum += side.forward == bool(faces[side.triangle]) ? 1 : -1;
    }
    if (sum > 0) result.push_back({from_light[edge.a], from_light[edge.b], sum});
    if (sum < 0) result.push_back({from_light[edge.b], from_light[edge.a], -sum});
  }
  return result;
}

}  // namespace airlight::shadow_planes
