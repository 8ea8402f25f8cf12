// A cube as text and bytes of every mesh format, and what read_mesh says of a file.
#pragma once
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "scene/base/error.h"
#include "scene/geometry/mesh_io.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace airlight::test {

inline const std::string data_folder = AIRLIGHT_SOURCE_DIR "/experiments/data/";

// The unit cube of six squares in each format; counter-clockwise seen from outside.
inline const std::vector<Point3> cube_vertices = {Point3(0, 0, 0), Point3(1, 0, 0), Point3(0, 1, 0), Point3(1, 1, 0),
                                                  Point3(0, 0, 1), Point3(1, 0, 1), Point3(0, 1, 1), Point3(1, 1, 1)};
inline const std::vector<std::array<int, 4>> cube_faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

inline std::string lines_of_vertices(const std::string& before) {
  std::string text;
  for (const Point3& v : cube_vertices)
    text +=
        before + std::to_string(int(v[0])) + " " + std::to_string(int(v[1])) + " " + std::to_string(int(v[2])) + "\n";
  return text;
}

inline std::string lines_of_faces(const std::string& before, int first) {
  std::string text;
  for (const auto& f : cube_faces) {
    text += before;
    for (const int v : f) text.append(" ").append(std::to_string(v + first));
    text += "\n";
  }
  return text;
}

inline std::string off_cube() { return "OFF\n# a cube\n8 6 0\n\n" + lines_of_vertices("") + lines_of_faces("4", 0); }
inline std::string obj_cube() {
  return "# a cube\no cube\n" + lines_of_vertices("v ") + "s off\n" + lines_of_faces("f", 1);
}

inline std::string ply_header(const std::string& format, const std::string& real) {
  return "ply\nformat " + format + " 1.0\ncomment a cube\nelement vertex 8\nproperty " + real + " x\nproperty " + real +
         " y\nproperty " + real + " z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
}
inline std::string ply_cube() { return ply_header("ascii", "float") + lines_of_vertices("") + lines_of_faces("4", 0); }

template <class T>
void put(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

inline std::string binary_ply_cube(bool big_endian) {
  std::string bytes = ply_header(big_endian ? "binary_big_endian" : "binary_little_endian", "double");
  for (const Point3& v : cube_vertices)
    for (int c = 0; c < 3; ++c) put(bytes, v[c], big_endian);
  for (const auto& f : cube_faces) {
    put(bytes, static_cast<unsigned char>(4), big_endian);
    for (const int v : f) put(bytes, std::int32_t(v), big_endian);
  }
  return bytes;
}

// Error message of read_mesh about a file of this name and content.
inline std::string message_for(const std::string& name, const std::string& content) {
  static const TemporaryFolder folder;  // one for all: making them takes longer than reading
  const std::string path = folder.file(name);
  write_bytes(path, content);
  const std::string text = message_of([&] { scene::read_mesh(path); }, path + "no error");
  CHECK(text.rfind(path, 0) == 0);
  return text.substr(path.size());
}

}  // namespace airlight::test
