// Wavefront OBJ: lines of a keyword and its arguments.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

#include "scene/geometry/mesh_check.h"
#include "scene/geometry/plain_mesh.h"
#include "scene/geometry/text_lines.h"

namespace airlight::scene {
namespace {

// What does not change the triangles. Curves and surfaces (curv, surf, ...) are not here: they would be lost silently.
constexpr std::array<std::string_view, 18> harmless = {
    "vt",     "vn",     "vp",     "l",      "p",     "o",        "g",        "s",   "mg",
    "usemtl", "mtllib", "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj"};

long long count_vertices(const std::string& path, const std::string& content) {
  TextLines lines(path, content);
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

}  // namespace

std::string plain_obj(const std::string& path, const std::string& content) {
  const long long vertices = count_vertices(path, content);
  TextLines lines(path, content);
  std::string positions, faces;
  long long before = 0;
  while (lines.next()) {
    const std::string_view kind = lines.word();
    if (kind == "v") {
      ++before;
      const double x = lines.number("a coordinate x"), y = lines.number("a coordinate y");
      fmt::format_to(std::back_inserter(positions), "v {} {} {}\n", x, y, lines.number("a coordinate z"));
    } else if (kind == "f") {
      int corners = 0;
      faces += 'f';
      for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
        if (word == "\\") {  // the face goes on in the next line
          if (!lines.next()) break;
          continue;
        }
        fmt::format_to(std::back_inserter(faces), " {}", read_corner(lines, word, before, vertices));
        ++corners;
      }
      faces += '\n';
      if (corners < 3 || corners > most_corners)
        lines.fail(fmt::format("found a face of {} corners, expected 3 to {}", corners, most_corners));
    } else if (std::find(harmless.begin(), harmless.end(), kind) == harmless.end()) {
      lines.fail(
          fmt::format("found '{}', expected v, vt, vn, f, l, p, o, g, s, usemtl or mtllib", TextLines::shown(kind)));
    }
  }
  if (faces.empty()) lines.fail("found the end of the file without a face, expected lines 'f ...'");
  return positions + faces;
}

}  // namespace airlight::scene
