#include "scene/geometry/clean_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "scene/geometry/ray_primitive.h"

namespace airlight::scene {
namespace {

// One number per position, the same for vertices that are stored twice.
std::vector<int> position_numbers(const std::vector<Point3>& vertices) {
  std::vector<int> order(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](int a, int b) {
    return std::lexicographical_compare(vertices[a].data(), vertices[a].data() + 3, vertices[b].data(),
                                        vertices[b].data() + 3);
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<int> numbers(vertices.size());
  int number = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && less(order[i - 1], order[i])) ++number;
    numbers[order[i]] = number;
  }
  return numbers;
}

}  // namespace

void remove_degenerate(TriangleMesh& mesh) {
  const auto degenerate = [&](const std::array<int, 3>& t) {
    const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    return accurate_cross(b - a, c - a).isZero(0) || b == c;
  };
  const auto kept = std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), degenerate);
  mesh.removed_degenerate += int(mesh.triangles.end() - kept);
  mesh.triangles.erase(kept, mesh.triangles.end());
}

std::vector<int> distinct_triangles(const TriangleMesh& mesh) {
  const std::vector<int> numbers = position_numbers(mesh.vertices);
  std::vector<std::array<int, 3>> keys;  // corners from the smallest on, winding kept
  keys.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    std::array<int, 3> key{numbers[t[0]], numbers[t[1]], numbers[t[2]]};
    std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
    keys.push_back(key);
  }
  std::vector<int> order(keys.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::tie(keys[a], a) < std::tie(keys[b], b); });
  order.erase(std::unique(order.begin(), order.end(), [&](int a, int b) { return keys[a] == keys[b]; }), order.end());
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace airlight::scene
