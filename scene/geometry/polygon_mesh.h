// Meshes as their files have them, each format read once and checked on the way.
#pragma once
#include <string>
#include <vector>

#include "scene/geometry/text_lines.h"
#include "scene/math/types.h"

namespace airlight::scene {

struct PolygonMesh {
  std::vector<Point3>
      vertices;              // as in the file: rounded to single precision, details far from the origin would be lost
  std::vector<int> corners;  // of all faces, one after the other: indices of vertices
  std::vector<std::size_t> ends;  // of the faces in `corners`

  void end_face() { ends.push_back(corners.size()); }
};

// Each throws Error: path, line (text formats) or byte (binary PLY), what was found, what was expected. Checked:
// header, announced counts against what is there, three numbers per vertex, all in the range of single precision, three to
// most_corners per face, indices in range. All but vertices and faces is passed over.
PolygonMesh read_off(const std::string& path, const std::string& content);
PolygonMesh read_obj(const std::string& path, const std::string& content);
PolygonMesh read_ply(const std::string& path, const std::string& content);

// Cutting a polygon into triangles takes the square of its corners: half a second for so many.
constexpr int most_corners = 10000;
int read_corner_count(TextLines&);  // of a face, from 3 on
Point3 read_point(TextLines&);      // x, y and z

}  // namespace airlight::scene
