#include "scene/geometry/mesh_io.h"

#include <assimp/BaseImporter.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>

#include "scene/error.h"
#include "scene/geometry/clean_mesh.h"
#include "scene/geometry/polygon_mesh.h"
#include "scene/read_file.h"

namespace airlight::scene {
namespace {

constexpr std::size_t max_bytes = std::size_t(1) << 30;

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

PolygonMesh read_polygons(const std::string& path, const std::string& content) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return read_obj(path, content);
  if (extension == ".off") return read_off(path, content);
  if (extension == ".ply") return read_ply(path, content);
  throw Error(fmt::format("{}: found a file named '{}', expected .obj, .ply or .off", path, extension));
}

// The library cuts polygons only in what one of its readers gave it: this one hands over what was read here.
class Handed : public Assimp::BaseImporter {
 public:
  static constexpr const char* extension = "polygons";
  explicit Handed(const PolygonMesh& mesh) : from_(mesh) {}
  bool CanRead(const std::string&, Assimp::IOSystem*, bool) const override { return true; }

 private:
  const aiImporterDesc* GetInfo() const override {
    static const aiImporterDesc info{"", "", "", "", 0, 0, 0, 0, 0, extension};
    return &info;
  }
  void InternReadFile(const std::string&, aiScene* scene, Assimp::IOSystem*) override {
    aiMesh& mesh = *new aiMesh;
    scene->mMeshes = new aiMesh* [scene->mNumMeshes = 1] { &mesh };
    scene->mRootNode = new aiNode;
    mesh.mVertices = new aiVector3D[mesh.mNumVertices = unsigned(from_.vertices.size())];
    std::transform(from_.vertices.begin(), from_.vertices.end(), mesh.mVertices,
                   [](const Point3& v) { return aiVector3D(float(v[0]), float(v[1]), float(v[2])); });
    mesh.mFaces = new aiFace[mesh.mNumFaces = unsigned(from_.ends.size())];
    std::size_t begin = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; begin = from_.ends[f++]) {
      const std::size_t count = from_.ends[f] - begin;
      mesh.mFaces[f].mIndices = new unsigned[mesh.mFaces[f].mNumIndices = unsigned(count)];
      std::copy_n(from_.corners.begin() + std::ptrdiff_t(begin), count, mesh.mFaces[f].mIndices);
    }
  }
  const PolygonMesh& from_;
};

TriangleMesh cut(const std::string& path, PolygonMesh from) {
  Assimp::Importer importer;
  importer.RegisterLoader(new Handed(from));  // the importer's from now on
  const aiScene* scene = importer.ReadFileFromMemory(" ", 1, aiProcess_Triangulate, Handed::extension);
  if (!scene) throw Error(fmt::format("{}: cannot be cut into triangles: {}", path, importer.GetErrorString()));
  TriangleMesh mesh;
  mesh.vertices = std::move(from.vertices);
  const aiMesh& triangles = *scene->mMeshes[0];
  for (const aiFace* f = triangles.mFaces; f != triangles.mFaces + triangles.mNumFaces; ++f)
    if (f->mNumIndices == 3) mesh.triangles.push_back({int(f->mIndices[0]), int(f->mIndices[1]), int(f->mIndices[2])});
  if (const std::size_t expected = from.corners.size() - 2 * from.ends.size(); mesh.triangles.size() != expected)
    throw Error(fmt::format("{}: polygons gave {} triangles, expected {}: a polygon crosses itself or has no area",
                            path, mesh.triangles.size(), expected));
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
