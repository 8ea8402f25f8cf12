#include "scene/geometry/polygon_mesh.h"

namespace airlight::scene {

int read_corner_count(TextLines& lines) { return int(lines.integer("the number of corners", 3, most_corners)); }

Point3 read_point(TextLines& lines) {
  const double x = lines.number("a coordinate x"), y = lines.number("a coordinate y");
  return {x, y, lines.number("a coordinate z")};
}

}  // namespace airlight::scene
