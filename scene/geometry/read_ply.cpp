// PLY: a text header that announces elements and their properties, then the elements as text or binary.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scene/base/error.h"
#include "scene/geometry/ply_header.h"
#include "scene/geometry/polygon_mesh.h"

namespace airlight::scene {
namespace {

using namespace ply;

void end_element(const Element& element, const Point3& place, PolygonMesh& mesh) {
  if (element.name == "vertex") mesh.vertices.push_back(place);
  if (element.name == "face") mesh.end_face();
}

void check_text(TextLines& lines, const Header& header, PolygonMesh& mesh) {
  for (const Element& element : header.elements)
    for (long long i = 0; i < element.count; ++i) {
      if (!lines.next())
        lines.fail(fmt::format("found the end of the file after {} of the element '{}', expected {}", i, element.name,
                               element.count));
      Point3 place = Point3::Zero();
      for (const Property& property : element.properties) {
        if (!property.count) {
          if (const int axis = coordinate(element, property); axis >= 0)
            place[axis] = lines.number("a coordinate");
          else if (lines.word().empty())
            lines.fail(fmt::format("found the end of the line, expected property {}", property.name));
          continue;
        }
        const bool corners = is_corners(element, property);
        const auto count = corners ? read_corner_count(lines) : lines.integer("the length of a list", 0, 1000000);
        for (long long k = 0; k < count; ++k) {
          if (corners)
            mesh.corners.push_back(int(lines.integer("the index of a vertex", 0, header.vertices - 1)));
          else if (lines.word().empty())
            lines.fail("found the end of the line in the middle of a list");
        }
      }
      end_element(element, place, mesh);
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

void check_binary(Bytes& bytes, const Header& header, PolygonMesh& mesh) {
  for (const Element& element : header.elements)
    for (long long i = 0; i < element.count; ++i) {
      Point3 place = Point3::Zero();
      for (const Property& property : element.properties) {
        if (!property.count) {
          const double value = bytes.scalar(property.value);
          const int axis = coordinate(element, property);
          if (axis < 0) continue;
          if (!(std::abs(value) <= std::numeric_limits<float>::max()))
            bytes.fail(fmt::format("found {}, expected a coordinate that is finite in single precision", value));
          place[axis] = value;
          continue;
        }
        const double count = bytes.scalar(*property.count);
        if (!is_corners(element, property)) {
          if (count < 0) bytes.fail(fmt::format("found a list of {} values", count));
          bytes.skip(std::size_t(count) * property.value.size);
          continue;
        }
        if (!(count >= 3 && count <= most_corners))
          bytes.fail(fmt::format("found a face of {} corners, expected 3 to {}", count, most_corners));
        for (double k = 0; k < count; ++k) {
          const double index = bytes.scalar(property.value);
          if (!(index >= 0 && index < double(header.vertices)))
            bytes.fail(
                fmt::format("found '{}', expected the index of a vertex from 0 to {}", index, header.vertices - 1));
          mesh.corners.push_back(int(index));
        }
      }
      end_element(element, place, mesh);
    }
}

}  // namespace

PolygonMesh read_ply(const std::string& path, const std::string& content) {
  TextLines lines(path, content);
  const Header header = read_header(lines, content.size());
  PolygonMesh mesh;
  if (header.format == Header::Format::text) {
    check_text(lines, header, mesh);
  } else {
    Bytes bytes(path, content, lines.rest(), header.format == Header::Format::big_endian);
    check_binary(bytes, header, mesh);
  }
  return mesh;
}

}  // namespace airlight::scene
