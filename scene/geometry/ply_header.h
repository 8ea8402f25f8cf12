// The header of a PLY file: which elements follow, and what each of them holds.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scene/geometry/text_lines.h"

namespace airlight::scene::ply {

struct Scalar {
  char kind = 'i';  // i: signed, u: unsigned, f: floating
  std::size_t size = 4;
};

struct Property {
  std::string name;
  std::optional<Scalar> count;  // of a list
  Scalar value;
};

struct Element {
  std::string name;
  long long count = 0;
  std::vector<Property> properties;
};

struct Header {
  enum class Format { text, little_endian, big_endian } format = Format::text;
  std::vector<Element> elements;
  long long vertices = 0;
};

// Reads up to the end of the header. Throws Error for what is none, and for what is no mesh: a vertex and a face at
// least, each element once, x, y and z, one list of corners, no strips of triangles. `size`: of the whole file, in
// bytes.
Header read_header(TextLines&, std::size_t size);

bool is_corners(const Element&, const Property&);
int coordinate(const Element&, const Property&);  // the axis; -1: none

}  // namespace airlight::scene::ply
