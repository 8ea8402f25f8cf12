#include "scene/geometry/plain_mesh.h"

#include <assimp/fast_atof.h>
#include <fmt/format.h>

#include <cmath>

namespace airlight::scene {
namespace {

template <class T>
void append(std::string& to, const T* values, std::size_t count) {
  to.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

// Thrown for more digits than the importer's reading of numbers takes.
struct TooLong {
  template <class... Texts>
  explicit TooLong(Texts&&...) {}
};

}  // namespace

long long read_corner_count(TextLines& lines) { return lines.integer("the number of corners", 3, most_corners); }

void PlainMesh::coordinate(int axis, TextLines& lines, const char* what) {
  const double value = lines.number(what);
  place_[axis] = float(value);
  try {
    const std::string word(lines.last_word());
    float rounded = 0;
    Assimp::fast_atoreal_move<float, TooLong>(word.c_str(), rounded);
    if (std::abs(rounded - value) <= 1e-6 * std::abs(value)) place_[axis] = rounded;
  } catch (const TooLong&) {
  }
}

void PlainMesh::end_vertex() {
  vertices_ += '\1';
  append(vertices_, place_.data(), 3);
  ++vertex_count_;
}

void PlainMesh::end_face() {
  const auto count = std::uint32_t(corners_.size());
  append(faces_, &count, 1);
  append(faces_, corners_.data(), count);
  corners_.clear();
  ++face_count_;
}

// A byte begins every vertex that means nothing: the importer skips line ends after the header, and a coordinate may
// begin with one.
std::string PlainMesh::content() && {
  std::string all = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty uchar confidence\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face {}\nproperty list uint uint vertex_indices\nend_header\n",
      vertex_count_, face_count_);
  all.reserve(all.size() + vertices_.size() + faces_.size());
  all += vertices_;
  std::string().swap(vertices_);  // each may be a gigabyte
  all += faces_;
  return all;
}

}  // namespace airlight::scene
