#include "methods/shadow_planes/silhouette.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

namespace airlight::shadow_planes {

MeshEdges::MeshEdges(const scene::TriangleMesh& mesh) {
  std::map<std::array<double, 3>, int> places;
  std::vector<int> place_of;
  for (const Point3& v : mesh.vertices) {
    const auto [found, is_new] = places.try_emplace({v[0], v[1], v[2]}, int(vertices_.size()));
    if (is_new) vertices_.push_back(v);
    place_of.push_back(found->second);
  }
  std::set<std::array<int, 3>> seen;
  std::map<std::array<int, 2>, std::vector<Side>> sides;
  for (const auto& t : mesh.triangles) {
    const std::array<int, 3> own = {place_of[t[0]], place_of[t[1]], place_of[t[2]]};
    std::array<int, 3> sorted = own;
    std::sort(sorted.begin(), sorted.end());
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2] || !seen.insert(sorted).second) continue;
    const int index = int(triangles_.size());
    triangles_.push_back(own);
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

std::vector<SilhouetteEdge> silhouette(const MeshEdges& mesh, const Point3& light) {
  std::vector<Vec3> from_light;
  from_light.reserve(mesh.vertices().size());
  for (const Point3& v : mesh.vertices()) from_light.push_back(v - light);
  // A triangle seen from its edge has no shadow: either side will do, if it is the same for its three edges.
  std::vector<char> faces_light;
  faces_light.reserve(mesh.triangles().size());
  for (const auto& t : mesh.triangles())
    faces_light.push_back(from_light[t[0]].dot(from_light[t[1]].cross(from_light[t[2]])) < 0);
  std::vector<SilhouetteEdge> result;
  for (const MeshEdges::Edge& edge : mesh.edges()) {
    int sum = 0;
    for (int k = edge.first; k < edge.first + edge.count; ++k) {
      const MeshEdges::Side& side = mesh.sides()[k];
      sum += side.forward == bool(faces_light[side.triangle]) ? 1 : -1;
    }
    if (sum > 0) result.push_back({from_light[edge.a], from_light[edge.b], sum});
    if (sum < 0) result.push_back({from_light[edge.b], from_light[edge.a], -sum});
  }
  return result;
}

}  // namespace airlight::shadow_planes
