#include <fmt/format.h>

#include "scene/geometry/mesh_check.h"
#include "scene/geometry/plain_mesh.h"
#include "scene/geometry/text_lines.h"

namespace airlight::scene {

std::string plain_off(const std::string& path, const std::string& content) {
  TextLines lines(path, content);
  PlainMesh plain;
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
    int axis = 0;
    for (const char* what : {"a coordinate x", "a coordinate y", "a coordinate z"})
      plain.coordinate(axis++, lines, what);
    plain.end_vertex();
  }
  for (long long i = 0; i < faces; ++i) {
    if (!lines.next()) lines.fail(fmt::format("found the end of the file after {} faces, expected {}", i, faces));
    const auto corners = read_corner_count(lines);
    for (long long k = 0; k < corners; ++k) plain.corner(lines.integer("the index of a vertex", 0, vertices - 1));
    plain.end_face();
  }
  if (lines.next()) lines.fail(fmt::format("found more after the {} faces that the header announces", faces));
  return std::move(plain).content();
}

}  // namespace airlight::scene
