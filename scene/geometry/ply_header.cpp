#include "scene/geometry/ply_header.h"

#include <fmt/format.h>

#include <algorithm>

namespace airlight::scene::ply {
namespace {

Scalar read_scalar(const TextLines& lines, std::string_view name) {
  for (const auto& [names, scalar] : {std::pair{"char int8", Scalar{'i', 1}},
                                      {"uchar uint8", {'u', 1}},
                                      {"short int16", {'i', 2}},
                                      {"ushort uint16", {'u', 2}},
                                      {"int int32", {'i', 4}},
                                      {"uint uint32", {'u', 4}},
                                      {"float float32", {'f', 4}},
                                      {"double float64", {'f', 8}}}) {
    const std::string_view both = names;
    const std::size_t space = both.find(' ');
    if (name == both.substr(0, space) || name == both.substr(space + 1)) return scalar;
  }
  lines.fail("found an unknown type of property, expected char, uchar, short, ushort, int, uint, float or double");
}

void read_format(TextLines& lines, Header::Format& format) {
  const std::string_view name = lines.word();
  if (name == "binary_little_endian")
    format = Header::Format::little_endian;
  else if (name == "binary_big_endian")
    format = Header::Format::big_endian;
  else if (name != "ascii")
    lines.fail("found an unknown format, expected ascii, binary_little_endian or binary_big_endian");
}

Element read_element(TextLines& lines, std::size_t size) {
  Element element;
  element.name = lines.word();
  // Every element takes a byte at least: a larger count cannot be true, and would only cost memory.
  element.count = lines.integer("the number of elements", 0, (long long)size);
  return element;
}

Property read_property(TextLines& lines) {
  Property property;
  std::string_view type = lines.word();
  if (type == "list") {
    property.count = read_scalar(lines, lines.word());
    if (property.count->kind == 'f') lines.fail("found a floating count of a list, expected an integer type");
    type = lines.word();
  }
  property.value = read_scalar(lines, type);
  property.name = lines.word();
  return property;
}

Header read_lines(TextLines& lines, std::size_t size) {
  Header header;
  bool has_format = false, ended = false;
  if (!lines.next() || lines.word() != "ply") lines.fail("found no PLY header, expected 'ply'");
  while (!ended && lines.next()) {
    const std::string_view key = lines.word();
    if (key == "comment" || key == "obj_info") continue;
    if (key == "end_header") {
      ended = true;
    } else if (key == "format") {
      read_format(lines, header.format);
      has_format = true;
    } else if (key == "element") {
      header.elements.push_back(read_element(lines, size));
    } else if (key == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(read_property(lines));
    } else {
      lines.fail("found an unknown line in the header, expected format, element, property, comment or end_header");
    }
  }
  if (!ended || !has_format) lines.fail("found an incomplete header, expected 'format' and 'end_header'");
  return header;
}

// The element of this name, which must be there once and not be empty.
const Element& only(const Header& header, const char* name, const TextLines& lines) {
  const auto named = [&](const Element& e) { return e.name == name; };
  const auto found = std::find_if(header.elements.begin(), header.elements.end(), named);
  if (found == header.elements.end() || found->count == 0)
    lines.fail(fmt::format("found no element '{}' in the header, expected at least one", name));
  if (std::count_if(header.elements.begin(), header.elements.end(), named) > 1)
    lines.fail(fmt::format("found the element '{}' twice in the header, expected it once", name));
  return *found;
}

void check_coordinates(const Element& vertex, const TextLines& lines) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto count = std::count_if(vertex.properties.begin(), vertex.properties.end(),
                                     [&](const Property& p) { return coordinate(vertex, p) == axis; });
    if (count != 1)
      lines.fail(fmt::format("found vertices {} a property {}", count ? "with twice" : "without", "xyz"[axis]));
  }
}

void check_corners(const Element& face, const TextLines& lines) {
  const auto lists = std::count_if(face.properties.begin(), face.properties.end(),
                                   [&](const Property& p) { return is_corners(face, p); });
  if (lists != 1)
    lines.fail(fmt::format("found faces {} a list of integers vertex_indices", lists ? "with twice" : "without"));
}

}  // namespace

bool is_corners(const Element& element, const Property& property) {
  return element.name == "face" && property.count && property.value.kind != 'f' &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

int coordinate(const Element& element, const Property& property) {
  if (element.name != "vertex" || property.count || property.name.size() != 1) return -1;
  return property.name[0] >= 'x' && property.name[0] <= 'z' ? property.name[0] - 'x' : -1;
}

Header read_header(TextLines& lines, std::size_t size) {
  Header header = read_lines(lines, size);
  const Element& vertex = only(header, "vertex", lines);
  const Element& face = only(header, "face", lines);
  header.vertices = vertex.count;
  for (const Element& e : header.elements)
    if (e.name == "tristrips" && e.count > 0) lines.fail("found strips of triangles, expected faces alone");
  check_coordinates(vertex, lines);
  check_corners(face, lines);
  return header;
}

}  // namespace airlight::scene::ply
