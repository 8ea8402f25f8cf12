// The file that the importer gets instead of the user's: a binary PLY with vertices in single precision, and faces.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/geometry/text_lines.h"

namespace airlight::scene {

// Cutting a polygon into triangles takes the square of its corners: half a second for so many.
constexpr int most_corners = 10000;
long long read_corner_count(TextLines&);  // of a face, from 3 on

class PlainMesh {
 public:
  void coordinate(int axis, double value) { place_[axis] = float(value); }
  // The next word of a text, rounded as the importer rounds it, which is not always to the nearest: references are
  // cached by the bits of vertices.
  void coordinate(int axis, TextLines&, const char* what);
  void end_vertex();
  void corner(long long vertex) { corners_.push_back(std::uint32_t(vertex)); }
  void end_face();

  std::string content() &&;

 private:
  std::string vertices_, faces_;
  std::size_t vertex_count_ = 0, face_count_ = 0;
  std::array<float, 3> place_{};
  std::vector<std::uint32_t> corners_;
};

}  // namespace airlight::scene
