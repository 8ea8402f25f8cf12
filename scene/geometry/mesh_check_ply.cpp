// PLY: a text header that announces elements and their properties, then the elements as text or binary.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "scene/error.h"
#include "scene/geometry/mesh_check.h"
#include "scene/geometry/text_lines.h"

namespace airlight::scene {
namespace {

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

Header read_header(TextLines& lines, std::size_t size) {
  Header header;
  bool has_format = false, ended = false;
  if (!lines.next() || lines.word() != "ply") lines.fail("found no PLY header, expected 'ply'");
  while (!ended && lines.next()) {
    const std::string_view key = lines.word();
    if (key == "comment" || key == "obj_info") continue;
    if (key == "end_header") {
      ended = true;
    } else if (key == "format") {
      const std::string_view name = lines.word();
      if (name == "binary_little_endian")
        header.format = Header::Format::little_endian;
      else if (name == "binary_big_endian")
        header.format = Header::Format::big_endian;
      else if (name != "ascii")
        lines.fail("found an unknown format, expected ascii, binary_little_endian or binary_big_endian");
      has_format = true;
    } else if (key == "element") {
      Element element;
      element.name = lines.word();
      // Every element takes a byte at least: a larger count cannot be true, and would only cost memory.
      element.count = lines.integer("the number of elements", 0, (long long)size);
      header.elements.push_back(element);
    } else if (key == "property" && !header.elements.empty()) {
      Property property;
      std::string_view type = lines.word();
      if (type == "list") {
        property.count = read_scalar(lines, lines.word());
        if (property.count->kind == 'f') lines.fail("found a floating count of a list, expected an integer type");
        type = lines.word();
      }
      property.value = read_scalar(lines, type);
      property.name = lines.word();
      header.elements.back().properties.push_back(property);
    } else {
      lines.fail("found an unknown line in the header, expected format, element, property, comment or end_header");
    }
  }
  if (!ended || !has_format) lines.fail("found an incomplete header, expected 'format' and 'end_header'");

  const auto element = [&](const char* name) {
    const auto found =
        std::find_if(header.elements.begin(), header.elements.end(), [&](const Element& e) { return e.name == name; });
    if (found == header.elements.end() || found->count == 0)
      lines.fail(fmt::format("found no element '{}' in the header, expected at least one", name));
    return found;
  };
  const auto vertex = element("vertex"), face = element("face");
  header.vertices = vertex->count;
  for (const char* axis : {"x", "y", "z"})
    if (std::none_of(vertex->properties.begin(), vertex->properties.end(),
                     [&](const Property& p) { return p.name == axis && !p.count; }))
      lines.fail(fmt::format("found vertices without a property {}", axis));
  if (std::none_of(face->properties.begin(), face->properties.end(), [](const Property& p) {
        return p.count && (p.name == "vertex_indices" || p.name == "vertex_index") && p.value.kind != 'f';
      }))
    lines.fail("found faces without a list of integers vertex_indices");
  return header;
}

bool is_corners(const Element& element, const Property& property) {
  return element.name == "face" && property.count && property.name.rfind("vertex_ind", 0) == 0;
}
bool is_coordinate(const Element& element, const Property& property) {
  return element.name == "vertex" && !property.count &&
         (property.name == "x" || property.name == "y" || property.name == "z");
}

void check_text(TextLines& lines, const Header& header) {
  for (const Element& element : header.elements)
    for (long long i = 0; i < element.count; ++i) {
      if (!lines.next())
        lines.fail(fmt::format("found the end of the file after {} of the element '{}', expected {}", i, element.name,
                               element.count));
      for (const Property& property : element.properties) {
        if (!property.count) {
          if (is_coordinate(element, property))
            lines.number("a coordinate");
          else if (lines.word().empty())
            lines.fail(fmt::format("found the end of the line, expected property {}", property.name));
          continue;
        }
        const bool corners = is_corners(element, property);
        const auto count = lines.integer("the length of a list", corners ? 3 : 0, 1000000);
        for (long long k = 0; k < count; ++k) {
          if (corners)
            lines.integer("the index of a vertex", 0, header.vertices - 1);
          else if (lines.word().empty())
            lines.fail("found the end of the line in the middle of a list");
        }
      }
    }
  if (lines.next()) lines.fail("found more after the elements that the header announces");
}

// Reads scalars of the binary part; every step is checked against the end of the file.
class Bytes {
 public:
  Bytes(const std::string& path, const std::string& content, std::string_view body, bool big_endian)
      : path_(path), all_(content), rest_(body), big_endian_(big_endian) {}

  void skip(std::size_t bytes) {
    if (bytes > rest_.size())
      throw Error(fmt::format("{}: found the end of the file after {} bytes, expected at least {}", path_, all_.size(),
                              position() + bytes));
    rest_.remove_prefix(bytes);
  }
  double scalar(const Scalar& type) {
    unsigned char raw[8] = {};
    const std::string_view from = rest_;
    skip(type.size);
    for (std::size_t i = 0; i < type.size; ++i) raw[i] = (unsigned char)from[big_endian_ ? type.size - 1 - i : i];
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.size; ++i) bits |= std::uint64_t(raw[i]) << (8 * i);
    if (type.kind == 'u') return double(bits);
    if (type.kind == 'f')
      return type.size == 8 ? std::bit_cast<double>(bits) : double(std::bit_cast<float>(std::uint32_t(bits)));
    const int unused = 64 - 8 * int(type.size);
    return double(std::int64_t(bits << unused) >> unused);
  }
  [[noreturn]] void fail(const std::string& found_and_expected) const {
    throw Error(fmt::format("{}: byte {}: {}", path_, position(), found_and_expected));
  }

 private:
  std::size_t position() const { return all_.size() - rest_.size(); }
  const std::string& path_;
  const std::string& all_;
  std::string_view rest_;
  bool big_endian_;
};

void check_binary(Bytes& bytes, const Header& header) {
  for (const Element& element : header.elements)
    for (long long i = 0; i < element.count; ++i)
      for (const Property& property : element.properties) {
        if (!property.count) {
          const double value = bytes.scalar(property.value);
          if (is_coordinate(element, property) && !(std::abs(value) <= std::numeric_limits<float>::max()))
            bytes.fail(fmt::format("found {}, expected a coordinate that is finite in single precision", value));
          continue;
        }
        const double count = bytes.scalar(*property.count);
        if (!is_corners(element, property)) {
          if (count < 0) bytes.fail(fmt::format("found a list of {} values", count));
          bytes.skip(std::size_t(count) * property.value.size);
          continue;
        }
        if (count < 3) bytes.fail(fmt::format("found a face of {} corners, expected at least 3", count));
        for (double k = 0; k < count; ++k) {
          const double index = bytes.scalar(property.value);
          if (!(index >= 0 && index < double(header.vertices)))
            bytes.fail(
                fmt::format("found '{}', expected the index of a vertex from 0 to {}", index, header.vertices - 1));
        }
      }
}

}  // namespace

void check_ply(const std::string& path, const std::string& content) {
  TextLines lines(path, content);
  const Header header = read_header(lines, content.size());
  if (header.format == Header::Format::text) return check_text(lines, header);
  Bytes bytes(path, content, lines.rest(), header.format == Header::Format::big_endian);
  check_binary(bytes, header);
}

}  // namespace airlight::scene
