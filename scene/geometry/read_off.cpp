#include <fmt/format.h>

#include "scene/geometry/polygon_mesh.h"

namespace airlight::scene {

PolygonMesh read_off(const std::string& path, const std::string& content) {
  TextLines lines(path, content);
  PolygonMesh mesh;
  if (!lines.next()) lines.fail("found an empty file, expected OFF");
  const std::string_view header = lines.word();
  if (header != "OFF" && header != "COFF" && header != "NOFF" && header != "CNOFF" && header != "STOFF")
    lines.fail("found another header, expected OFF in text form");
  // The counts stand on the next line, or beside the header.
  if (lines.at_end() && !lines.next()) lines.fail("found the end of the file, expected the counts");
  // A vertex takes 6 bytes at least and a face 8: a larger count cannot be true, and would only cost memory.
  const auto vertices = lines.integer("the number of vertices", 1, (long long)content.size() / 5);
  const auto faces = lines.integer("the number of faces", 1, (long long)content.size() / 6);
  for (long long i = 0; i < vertices; ++i) {
    if (!lines.next()) lines.fail(fmt::format("found the end of the file after {} vertices, expected {}", i, vertices));
    mesh.vertices.push_back(read_point(lines));
  }
  for (long long i = 0; i < faces; ++i) {
    if (!lines.next()) lines.fail(fmt::format("found the end of the file after {} faces, expected {}", i, faces));
    for (int k = read_corner_count(lines); k > 0; --k) {
      if (lines.at_end() && !lines.next()) lines.fail("found the end of the file within a face");
      mesh.corners.push_back(int(lines.integer("the index of a vertex", 0, vertices - 1)));
    }
    mesh.end_face();
  }
  if (lines.next()) lines.fail(fmt::format("found more after the {} faces that the header announces", faces));
  return mesh;
}

}  // namespace airlight::scene
