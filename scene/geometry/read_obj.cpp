// Wavefront OBJ: lines of a keyword and its arguments.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include "scene/geometry/polygon_mesh.h"

namespace airlight::scene {
namespace {

// Statements that do not change the triangles. Curves and surfaces (curv, surf, ...) are not here: they
// would be lost silently.
constexpr std::array<std::string_view, 18> harmless = {
    "vt",     "vn",     "vp",     "l",      "p",     "o",        "g",        "s",   "mg",
    "usemtl", "mtllib", "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj"};

long long count_vertices(const std::string& path, const std::string& content) {
  TextLines lines(path, content, /*continued=*/true);
  long long count = 0;
  while (lines.next()) count += lines.word() == "v";
  return count;
}

// "5", "5/1", "5//2", "-1/1/1": the position alone, counted from 1.
long long read_corner(const TextLines& lines, std::string_view word, long long before, long long vertices) {
  long long index = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
  const bool ends = end == word.data() + word.size() || *end == '/';
  const long long position = index < 0 ? before + 1 + index : index;
  if (error != std::errc() || !ends || position < 1 || position > vertices)
    lines.fail(fmt::format("found '{}', expected the index of a vertex from 1 to {} (or negative, from the last one)",
                           TextLines::shown(word), vertices));
  return position;
}

// Vertices at one place become one, those of no face none; they are numbered as the faces name them.
void join_vertices(PolygonMesh& mesh) {
  std::map<std::array<double, 3>, int> numbers;
  std::vector<Point3> vertices;
  for (int& corner : mesh.corners) {
    const Point3& v = mesh.vertices[corner];
    const auto [place, is_new] = numbers.try_emplace({v[0], v[1], v[2]}, int(vertices.size()));
    if (is_new) vertices.push_back(v);
    corner = place->second;
  }
  mesh.vertices = std::move(vertices);
}

}  // namespace

PolygonMesh read_obj(const std::string& path, const std::string& content) {
  const long long vertices = count_vertices(path, content);
  TextLines lines(path, content, /*continued=*/true);
  PolygonMesh mesh;
  while (lines.next()) {
    const std::string_view kind = lines.word();
    if (kind == "v") {
      mesh.vertices.push_back(read_point(lines));
    } else if (kind == "f") {
      const std::size_t first = mesh.corners.size();
      for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
        mesh.corners.push_back(int(read_corner(lines, word, (long long)mesh.vertices.size(), vertices) - 1));
      }
      mesh.end_face();
      if (const std::size_t corners = mesh.corners.size() - first; corners < 3 || corners > most_corners)
        lines.fail(fmt::format("found a face of {} corners, expected 3 to {}", corners, most_corners));
    } else if (std::find(harmless.begin(), harmless.end(), kind) == harmless.end()) {
      lines.fail(
          fmt::format("found '{}', expected v, vt, vn, f, l, p, o, g, s, usemtl or mtllib", TextLines::shown(kind)));
    }
  }
  if (mesh.ends.empty()) lines.fail("found the end of the file without a face, expected lines 'f ...'");
  join_vertices(mesh);
  return mesh;
}

}  // namespace airlight::scene
