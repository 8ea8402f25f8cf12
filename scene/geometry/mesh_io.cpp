#include "scene/geometry/mesh_io.h"

#include <fmt/format.h>

#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/base/read_file.h"
#include "scene/geometry/clean_mesh.h"
#include "scene/geometry/polygon_cut.h"
#include "scene/geometry/polygon_mesh.h"

namespace airlight::scene {
namespace {

constexpr std::size_t max_bytes = std::size_t(1) << 30;

PolygonMesh read_polygons(const std::string& path, const std::string& content) {
  const std::string extension = file_ending(path);
  if (extension == ".obj") return read_obj(path, content);
  if (extension == ".off") return read_off(path, content);
  if (extension == ".ply") return read_ply(path, content);
  throw Error(fmt::format("{}: found a file named '{}', expected .obj, .ply or .off", path, extension));
}

TriangleMesh cut(const std::string& path, PolygonMesh from) {
  TriangleMesh mesh;
  mesh.triangles.reserve(from.corners.size() - 2 * from.ends.size());
  std::size_t begin = 0;
  for (std::size_t face = 0; face < from.ends.size(); begin = from.ends[face++]) {
    const int* const numbers = from.corners.data() + begin;
    std::vector<Point3> corners;
    for (std::size_t i = begin; i < from.ends[face]; ++i) corners.push_back(from.vertices[from.corners[i]]);
    const auto triangles = cut_polygon(corners);
    if (!triangles)
      throw Error(fmt::format("{}: face {} of {} corners crosses itself, expected one that can be cut into triangles",
                              path, face + 1, corners.size()));
    for (const auto& t : *triangles) mesh.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
  }
  mesh.vertices = std::move(from.vertices);
  return mesh;
}

}  // namespace

TriangleMesh read_mesh(const std::string& path) {
  TriangleMesh mesh = cut(path, read_polygons(path, read_whole_file(path, max_bytes)));
  remove_degenerate(mesh);
  if (mesh.triangles.empty()) throw Error(fmt::format("{}: found no triangle with an area", path));
  return mesh;
}

}  // namespace airlight::scene
