#include "scene/geometry/mesh_io.h"

#include <Eigen/Geometry>
#include <bit>
#include <catch2/catch.hpp>
#include <cstring>
#include <map>
#include <random>

#include "scene/base/error.h"
#include "tests/scene/geometry_scenes.h"
#include "tests/scene/mesh_texts.h"
#include "tests/temporary_folder.h"

namespace mesh_io_test {

using namespace airlight;
using namespace airlight::scene;
using namespace airlight::test;
using Catch::Contains;

namespace {

// Each directed edge once, and its opposite once.
bool closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (count != 1 || opposite == edges.end() || opposite->second != 1) return false;
  }
  return true;
}

}  // namespace

TEST_CASE("a cube is the same from every format", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  for (const auto& [name, content] :
       std::map<std::string, std::string>{{"a.off", off_cube()},
                                          {"b.obj", obj_cube()},
                                          {"c.ply", ply_cube()},
                                          {"d.ply", binary_ply_cube(false)},
                                          {"e.PLY", binary_ply_cube(true)},
                                          {"f.off", replaced(off_cube(), "OFF\n# a cube\n8", "OFF 8")}}) {
    CAPTURE(name);
    write_bytes(folder.file(name), content);
    const TriangleMesh mesh = read_mesh(folder.file(name));
    CHECK(mesh.vertices.size() == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(mesh.removed_degenerate == 0);
    CHECK(volume(mesh) == Approx(1));
    CHECK(closed(mesh));
  }
}

// Changes by editors and other programs: a byte order mark before the text, lines that continue behind a backslash,
// faces over two lines.
TEST_CASE("a cube in other spellings is a cube", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF";
  for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
           {"a.off", mark + off_cube()},
           {"b.obj", mark + obj_cube()},
           {"c.ply", mark + ply_cube()},
           {"d.ply", mark + binary_ply_cube(false)},
           {"e.obj", replaced(obj_cube(), "f 1 5 7 3", "f 1 5\\\n7 3")},
           {"f.obj", replaced(obj_cube(), "f 1 5 7 3", "f 1 \\\r\n 5 7\\\r\n 3")},
           {"g.obj", replaced(obj_cube(), "v 1 0 0", "v 1 \\\n0 0")},
           {"h.obj", "# C:\\cubes\\\n" + obj_cube()},  // a comment goes on nowhere
           {"i.off", replaced(off_cube(), "4 0 4 6 2", "4 0 4\n6 2")},
           {"j.off", replaced(off_cube(), "4 0 4 6 2", "4\n0 4 6 2 0.5 0.5 0.5")}}) {
    CAPTURE(name);
    write_bytes(folder.file(name), content);
    const TriangleMesh mesh = read_mesh(folder.file(name));
    CHECK(mesh.vertices.size() == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(volume(mesh) == Approx(1));
    CHECK(closed(mesh));
  }
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "f 1 5 7 3", "f 1 5\\\n9 3")), Contains(":13: found '9'"));
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "4 0 4 6 2", "4 0 4 6")), Contains("expected 6"));
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "4 4 5 7 6", "4 4 5 7")),
             Contains("found the end of the file within a face"));
}

// An L of area 3, with a corner on the diagonal of two others.
TEST_CASE("concave faces cover what they enclose", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const std::string vertices = "v -1 -1 0\nv 1 -1 0\nv 1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\n";
  for (const std::string face : {"f 1 2 3 4 5 6\n", "f 6 5 4 3 2 1\n", "f 4 5 6 1 2 3\n"}) {
    write_bytes(folder.file("a.obj"), vertices + face);
    const TriangleMesh mesh = read_mesh(folder.file("a.obj"));
    CHECK(mesh.triangles.size() == 4);
    double area = 0;
    for (const auto& t : mesh.triangles)
      area +=
          0.5 * Vec3(mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm();
    CHECK(area == Approx(3));
  }
  CHECK_THAT(message_for("a.obj", "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\nv -1 1 0\nf 1 2 3\nf 1 2 3 4 5\n"),
             Contains(": face 2 of 5 corners crosses itself"));
}

// Sizes as the file headers say; closed, as their makers say.
TEST_CASE("the meshes of the experiments are read whole", "[geometry][mesh_io]") {
  for (const auto& [name, triangles] :
       {std::pair{"oblong.off", 840}, {"blobby.off", 4050}, {"elephant.off", 5558}, {"knot1.off", 6400}}) {
    CAPTURE(name);
    const TriangleMesh mesh = read_mesh(data_folder + name);
    CHECK(int(mesh.triangles.size()) + mesh.removed_degenerate == triangles);
    CHECK(closed(mesh));
    CHECK(volume(mesh) > 0);
  }
}

TEST_CASE("vertices are the numbers of the file", "[geometry][mesh_io]") {
  CHECK(read_mesh(data_folder + "blobby.off").vertices[0] == Point3(0.0958494, 0.00115985, -0.166522));
  const TemporaryFolder folder;
  const std::string digits(400, '0');
  write_bytes(folder.file("a.off"),
              "OFF\n3 1 0\n1." + digits + "1 0 0\n0 1000000000000000000000000 0\n0 0 +1.e-4\n3 0 1 2\n");
  const TriangleMesh mesh = read_mesh(folder.file("a.off"));
  CHECK(mesh.vertices[0][0] == 1);
  CHECK(mesh.vertices[1][1] == 1e24);
  CHECK(mesh.vertices[2][2] == 1e-4);
}

// Coordinates of a map projection: in single precision, neighbouring numbers are half a metre apart there.
TEST_CASE("a mesh far from the origin keeps its shape", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const std::string text =
      "445812.37 5411234.88 0\n445812.47 5411234.88 0\n445812.47 5411234.98 0\n445812.37 5411234.98 0\n";
  std::string obj;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
    obj += "v " + text.substr(at, text.find('\n', at) + 1 - at);
  write_bytes(folder.file("a.obj"), obj + "f 1 2 3 4\n");
  write_bytes(folder.file("b.off"), "OFF\n4 1 0\n" + text + "4 0 1 2 3\n");
  const std::string of_doubles =
      replaced(replaced(ply_header("ascii", "double"), "vertex 8", "vertex 4"), "face 6", "face 1");
  write_bytes(folder.file("c.ply"), of_doubles + text + "4 0 1 2 3\n");
  std::string binary = replaced(of_doubles, "ascii", "binary_little_endian");
  for (const double x :
       {445812.37, 5411234.88, 0.0, 445812.47, 5411234.88, 0.0, 445812.47, 5411234.98, 0.0, 445812.37, 5411234.98, 0.0})
    put(binary, x, false);
  put(binary, std::uint8_t(4), false);
  for (const std::int32_t corner : {0, 1, 2, 3}) put(binary, corner, false);
  write_bytes(folder.file("d.ply"), binary);
  for (const char* name : {"a.obj", "b.off", "c.ply", "d.ply"}) {
    CAPTURE(name);
    const TriangleMesh mesh = read_mesh(folder.file(name));
    double area = 0;
    for (const auto& t : mesh.triangles)
      area += 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])[2];
    CHECK(area == Approx(0.01).epsilon(1e-6));
  }
}

TEST_CASE("faces of all kinds", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.obj");
  // Relative indices, texture and normal indices, an L-shaped polygon (area 3), a line, a point, two objects, a
  // material.
  write_bytes(path,
              "mtllib none.mtl\no first\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nvn 0 0 1\nvt 0 0\n"
              "usemtl grey\nf 1/1/1 2/1/1 3/1/1 4/1/1 5/1/1 6/1/1\nl 1 2\np 1\no second\nf -6//1 -5//1 -1//1\n"
              "f 1 1 2\nf 1 2 \\\n 6\n");
  const TriangleMesh mesh = read_mesh(path);
  CHECK(mesh.vertices.size() == 6);
  CHECK(mesh.removed_degenerate == 1);
  REQUIRE(mesh.triangles.size() == 6);
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += 0.5 * (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])[2];
  CHECK(area == Approx(3 + 2 + 2));
}

// Other elements, properties, types and orders than usual: the mesh stays the same.
TEST_CASE("a PLY cube with more in it is a cube", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  std::vector<std::string> files;
  // An element with lists of what might be corners.
  std::string other =
      replaced(ply_cube(), "element face", "element x 2\nproperty list uchar int vertex_indices\nelement face");
  files.push_back(replaced(other, "4 0 4 6 2", "3 0 0 0\n0\n4 0 4 6 2"));
  // Faces before vertices.
  const std::string cube = ply_cube(), end = "end_header\n";
  const std::size_t vertex = cube.find("element vertex"), face = cube.find("element face"), body = cube.find(end);
  const std::size_t faces = body + end.size() + lines_of_vertices("").size();
  files.push_back(cube.substr(0, vertex) + cube.substr(face, body - face) + cube.substr(vertex, face - vertex) + end +
                  cube.substr(faces) + lines_of_vertices(""));
  files.push_back(replaced(cube, "vertex_indices", "vertex_index"));
  for (const std::string& content : files) {
    CAPTURE(content);
    write_bytes(folder.file("a.ply"), content);
    const TriangleMesh mesh = read_mesh(folder.file("a.ply"));
    CHECK(mesh.vertices.size() == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(volume(mesh) == Approx(1));
    CHECK(closed(mesh));
  }
}

// Whatever the first bytes after the header are: blanks, ends of lines, comments.
TEST_CASE("binary PLY that begins like text", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  for (const bool big : {false, true})
    for (std::uint32_t byte = 1; byte < 0x7f; ++byte) {
      std::string bytes = ply_header(big ? "binary_big_endian" : "binary_little_endian", "float");
      bytes = replaced(replaced(bytes, "vertex 8", "vertex 3"), "face 6", "face 1");
      const float first = std::bit_cast<float>(byte * 0x01010101u);
      for (const float x : {first, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) put(bytes, x, big);
      put(bytes, std::uint8_t(3), big);
      for (const std::int32_t corner : {0, 1, 2}) put(bytes, corner, big);
      write_bytes(folder.file("a.ply"), bytes);
      CAPTURE(byte, big);
      const TriangleMesh mesh = read_mesh(folder.file("a.ply"));
      REQUIRE(mesh.vertices.size() == 3);
      CHECK(mesh.vertices[0] == Point3(first, 0, 0));
      CHECK(mesh.vertices[2] == Point3(0, 0, 1));
    }
}

// Readers are known that leave out faces of ten corners, or end at lines of 4096 bytes.
TEST_CASE("polygons of many corners", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  for (const int corners : {9, 10, 11, 600, 3000}) {
    std::string vertices, face = std::to_string(corners), obj = "f";
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * pi * i / corners;
      vertices += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
      face += " " + std::to_string(i);
      obj += " " + std::to_string(i + 1);
    }
    std::string bare = vertices;
    bare.erase(std::remove(bare.begin(), bare.end(), 'v'), bare.end());
    const std::string count = std::to_string(corners);
    // A triangle more: where a polygon is left out, there is still a mesh.
    write_bytes(folder.file("a.off"), "OFF\n" + count + " 2 0\n" + bare + face + "\n3 0 1 2\n");
    write_bytes(folder.file("b.obj"), vertices + obj + "\nf 1 2 3\n");
    write_bytes(folder.file("c.ply"), "ply\nformat ascii 1.0\nelement vertex " + count +
                                          "\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
                                          "property list ushort int vertex_indices\nend_header\n" +
                                          bare + face + "\n3 0 1 2\n");
    for (const char* name : {"a.off", "b.obj", "c.ply"}) {
      CAPTURE(name, corners);
      CHECK(int(read_mesh(folder.file(name)).triangles.size()) == corners - 1);
    }
  }
  std::string many = "20000";
  for (int i = 0; i < 20000; ++i) many += " 0";
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "4 0 4 6 2", many)),
             Contains("found '20000', expected the number of corners from 3 to 10000"));
  CHECK_THAT(message_for("a.ply", replaced(ply_cube(), "4 0 4 6 2", many)), Contains("from 3 to 10000"));
  std::string obj = "f";
  for (int i = 0; i < 20000; ++i) obj += " 1";
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "f 1 5 7 3", obj)),
             Contains("found a face of 20000 corners, expected 3 to 10000"));
}

}  // namespace mesh_io_test
