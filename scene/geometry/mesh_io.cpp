#include "scene/geometry/mesh_io.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>
#include <map>

#include "scene/error.h"
#include "scene/geometry/clean_mesh.h"
#include "scene/geometry/mesh_check.h"
#include "scene/read_file.h"

namespace airlight::scene {
namespace {

constexpr std::size_t max_bytes = std::size_t(1) << 30;

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

// What the importer is given, once the file is known to be whole, and as which format.
struct Plain {
  std::string content;
  const char* format;
};
Plain checked(const std::string& path, const std::string& extension, std::string content) {
  if (extension == ".obj") return {plain_obj(path, content), "obj"};
  if (extension == ".off") return {plain_off(path, content), "ply"};
  if (extension == ".ply") return {plain_ply(path, content), "ply"};
  throw Error(fmt::format("{}: found a file named '{}', expected .obj, .ply or .off", path, extension));
}

// What polygons cut into triangles must give.
long long triangles_expected(const aiScene& scene) {
  long long count = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
    for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
      count += std::max(0, int(scene.mMeshes[m]->mFaces[f].mNumIndices) - 2);
  return count;
}

void append(const aiMesh& from, TriangleMesh& mesh) {
  const int first = int(mesh.vertices.size());
  for (unsigned i = 0; i < from.mNumVertices; ++i)
    mesh.vertices.emplace_back(from.mVertices[i].x, from.mVertices[i].y, from.mVertices[i].z);
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    if (face.mNumIndices != 3) continue;
    mesh.triangles.push_back(
        {first + int(face.mIndices[0]), first + int(face.mIndices[1]), first + int(face.mIndices[2])});
  }
}

// The importer gives every corner of an OBJ face a vertex of its own; those at one place become one again.
void join_vertices(TriangleMesh& mesh) {
  std::map<std::array<double, 3>, int> numbers;
  std::vector<Point3> vertices;
  std::vector<int> number(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Point3& v = mesh.vertices[i];
    const auto [place, is_new] = numbers.try_emplace({v[0], v[1], v[2]}, int(vertices.size()));
    if (is_new) vertices.push_back(v);
    number[i] = place->second;
  }
  for (auto& triangle : mesh.triangles)
    for (int& v : triangle) v = number[v];
  mesh.vertices = std::move(vertices);
}

}  // namespace

TriangleMesh read_mesh(const std::string& path) {
  const std::string extension = lower_extension(path);
  const auto [content, format] = checked(path, extension, read_whole_file(path, max_bytes));

  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(content.data(), content.size(), 0, format);
  const long long expected = scene ? triangles_expected(*scene) : 0;
  if (scene) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene) {
    std::string reason = importer.GetErrorString();
    reason = reason.substr(0, std::min<std::size_t>(200, reason.find('\n')));
    throw Error(fmt::format("{}: cannot be read: {}", path, reason));
  }
  TriangleMesh mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) append(*scene->mMeshes[m], mesh);
  if ((long long)mesh.triangles.size() != expected)
    throw Error(fmt::format("{}: polygons gave {} triangles, expected {}: a polygon crosses itself or has no area",
                            path, mesh.triangles.size(), expected));
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle)
      if (v < 0 || std::size_t(v) >= mesh.vertices.size())
        throw Error(
            fmt::format("{}: found the vertex {} in a face, expected 0 to {}", path, v, mesh.vertices.size() - 1));
  for (const Point3& v : mesh.vertices)
    if (!v.allFinite()) throw Error(fmt::format("{}: found a vertex that is not finite", path));
  if (extension == ".obj") join_vertices(mesh);
  remove_degenerate(mesh);
  if (mesh.triangles.empty()) throw Error(fmt::format("{}: found no triangle with an area", path));
  return mesh;
}

}  // namespace airlight::scene
