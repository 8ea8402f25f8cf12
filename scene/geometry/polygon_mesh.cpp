#include "scene/geometry/polygon_mesh.h"

#include <assimp/fast_atof.h>

#include <cmath>

namespace airlight::scene {
namespace {

// Thrown for more digits than the importer's reading of numbers takes.
struct TooLong {
  template <class... Texts>
  explicit TooLong(Texts&&...) {}
};

}  // namespace

int read_corner_count(TextLines& lines) { return int(lines.integer("the number of corners", 3, most_corners)); }

// Rounded as the importer rounds, which is not always to the nearest: references are cached by the bits of vertices.
double read_coordinate(TextLines& lines, const char* what) {
  const double value = lines.number(what);
  try {
    float rounded = 0;
    Assimp::fast_atoreal_move<float, TooLong>(std::string(lines.last_word()).c_str(), rounded);
    if (std::abs(rounded - value) <= 1e-6 * std::abs(value)) return rounded;
  } catch (const TooLong&) {
  }
  return float(value);
}

Point3 read_point(TextLines& lines) {
  const double x = read_coordinate(lines, "a coordinate x"), y = read_coordinate(lines, "a coordinate y");
  return {x, y, read_coordinate(lines, "a coordinate z")};
}

}  // namespace airlight::scene
