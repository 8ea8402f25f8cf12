// Mesh files that are none, are cut short or damaged.
#include <map>
#include <random>

#include "tests/scene/mesh_texts.h"

namespace mesh_faults_test {

using namespace airlight;
using namespace airlight::scene;
using namespace airlight::test;
using Catch::Contains;

TEST_CASE("meshes that are none are refused in one line", "[geometry][mesh_io]") {
  CHECK_THROWS_WITH(read_mesh("/no/such/mesh.off"), Contains("/no/such/mesh.off: no such file"));
  CHECK_THROWS_AS(read_mesh(data_folder), Error);
  for (const char* name : {"a.off", "a.obj", "a.ply"}) {
    CHECK_THAT(message_for(name, ""), Contains("empty file"));
    CHECK_THAT(message_for(name, "\n \n"), Contains("found"));
    CHECK_THAT(message_for(name, "hello world\n"), Contains("found"));
    CHECK_THAT(message_for(name, std::string(1000, '\0')), Contains("found"));
  }
  CHECK_THAT(message_for("a.stl", off_cube()), Contains("found a file named '.stl', expected .obj, .ply or .off"));
  CHECK_THAT(message_for("a.obj", off_cube()), Contains(":1: found 'OFF', expected v"));

  CHECK_THAT(message_for("a.off", replaced(off_cube(), "1 0 0", "1 nan 0")),
             Contains(":6: found 'nan', expected a coordinate y that is finite"));
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "v 1 0 0", "v 1 0 1e39")), Contains(":4: found '1e39'"));
  CHECK_THAT(message_for("a.ply", replaced(ply_cube(), "1 0 0", "1 x 0")),
             Contains(":12: found 'x', expected a coordinate"));
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "4 0 4 6 2", "4 0 4 8 2")),
             Contains(":13: found '8', expected the index of a vertex from 0 to 7"));
  CHECK_THAT(message_for("a.ply", replaced(ply_cube(), "4 0 4 6 2", "4 0 4 -1 2")), Contains("found '-1'"));
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "f 1 5 7 3", "f 1 5 9 3")),
             Contains(":12: found '9', expected the index"));
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "f 1 5 7 3", "f 1 0 7 3")), Contains("found '0'"));
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "f 1 5 7 3", "f 1 -9 7 3")), Contains("found '-9'"));
  CHECK_THAT(message_for("a.obj", "v 0 0 0\n"), Contains("without a face"));
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "s off", "curv 0 1 2")), Contains(":11: found 'curv'"));
  CHECK_THAT(message_for("a.obj", replaced(obj_cube(), "f 1 5 7 3", "f 1 5")), Contains("found a face of 2 corners"));
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "4 0 4 6 2", "2 0 4")),
             Contains("expected the number of corners"));
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "8 6 0", "8 5 0")), Contains("found more after the 5 faces"));
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "8 6 0", "8 7 0")), Contains("after 6 faces, expected 7"));
  CHECK_THAT(message_for("a.ply", replaced(ply_cube(), "face 6", "face 7")),
             Contains("after 6 of the element 'face', expected 7"));
  CHECK_THAT(message_for("a.ply", replaced(ply_cube(), "property float z\n", "")), Contains("without a property z"));
  CHECK_THAT(message_for("a.ply", replaced(ply_cube(), "list uchar int vertex_indices", "list uchar int q")),
             Contains("vertex_indices"));
  CHECK_THAT(message_for("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n"), Contains("no triangle with an area"));

  // Counts that would ask for gigabytes, refused at once.
  CHECK_THAT(message_for("a.off", replaced(off_cube(), "8 6 0", "2000000000 6 0")), Contains("found '2000000000'"));
  CHECK_THAT(message_for("a.ply", replaced(ply_cube(), "vertex 8", "vertex 2000000000")),
             Contains("found '2000000000'"));
  CHECK_THAT(message_for("a.ply", replaced(binary_ply_cube(false), "face 6", "face 9999999999999999999")),
             Contains("found '9999"));
}

// The fuzzer's: a reader that takes one of these aborts, writes out of bounds or asks for gigabytes.
TEST_CASE("PLY headers of what is no mesh are refused", "[geometry][mesh_io]") {
  const std::string cube = ply_cube();
  const std::string more = "element vertex 9\nproperty float x\nproperty float y\nproperty float z\n";
  CHECK_THAT(message_for("a.ply", replaced(cube, "element face", more + "element face")),
             Contains("found the element 'vertex' twice"));
  const std::string faces = "element face 9\nproperty list uchar int vertex_indices\n";
  CHECK_THAT(message_for("a.ply", replaced(cube, "end_header", faces + "end_header")),
             Contains("found the element 'face' twice"));
  CHECK_THAT(message_for("a.ply", replaced(cube, "end_header",
                                           "element tristrips 1\nproperty list int int vertex_indices\nend_header")),
             Contains("strips of triangles"));
  CHECK_THAT(message_for("a.ply", replaced(cube, "property float y", "property float x\nproperty float y")),
             Contains("with twice a property x"));
  CHECK_THAT(message_for("a.ply", replaced(cube, "end_header", "property list uchar int vertex_index\nend_header")),
             Contains("with twice a list"));
  CHECK_THAT(message_for("a.ply", replaced(cube, "uchar int vertex", "uchar float vertex")),
             Contains("without a list"));
}

// Cut at every byte. The text formats end in numbers: a cut inside the last of them leaves a whole file with another
// number, and a cut between lines of an OBJ file leaves a whole, smaller one; nothing can tell these.
TEST_CASE("meshes cut short are refused", "[geometry][mesh_io]") {
  for (const auto& [name, content] : std::map<std::string, std::string>{{"a.off", off_cube()},
                                                                        {"a.ply", ply_cube()},
                                                                        {"b.ply", binary_ply_cube(false)},
                                                                        {"c.ply", binary_ply_cube(true)}}) {
    // The last digit and the last line break of the text may go.
    const std::size_t needed = content.size() - (name[0] == 'a' ? 1 : 0);
    for (std::size_t length = 0; length < needed; ++length) {
      CAPTURE(name, length, content.size());
      CHECK(message_for(name, content.substr(0, length)) != "no error");
    }
  }
  const std::string obj = obj_cube();
  int accepted = 0;
  for (std::size_t length = 0; length < obj.size(); ++length) {
    const bool whole_line = obj[length] == '\n' || (length > 0 && obj[length - 1] == '\n');
    if (message_for("a.obj", obj.substr(0, length)) == "no error") {
      CAPTURE(length);
      // Either between lines, or a face that already has three corners.
      const std::string last = obj.substr(0, length).substr(obj.substr(0, length).rfind('\n') + 1);
      CHECK((whole_line || std::count(last.begin(), last.end(), ' ') >= 3));
      ++accepted;
    }
  }
  CHECK(accepted < 40);
}

// Bytes changed at random, in every format: refused, or another mesh of which every index is in range.
TEST_CASE("damaged meshes are refused or harmless", "[geometry][mesh_io]") {
  const TemporaryFolder folder;
  std::mt19937 random(9);
  int refused = 0, trials = 0;
  for (const auto& [name, content] : std::map<std::string, std::string>{{"a.off", off_cube()},
                                                                        {"a.obj", obj_cube()},
                                                                        {"a.ply", ply_cube()},
                                                                        {"b.ply", binary_ply_cube(false)},
                                                                        {"c.ply", binary_ply_cube(true)}})
    for (int trial = 0; trial < 100; ++trial, ++trials) {
      std::string bytes = content;
      for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = char(trial % 2 ? 32 + random() % 95 : random());
      const std::string path = folder.file(name);
      write_bytes(path, bytes);
      try {
        const TriangleMesh mesh = read_mesh(path);
        for (const auto& t : mesh.triangles)
          for (const int v : t) REQUIRE((v >= 0 && std::size_t(v) < mesh.vertices.size()));
        for (const Point3& v : mesh.vertices) REQUIRE(v.allFinite());
      } catch (const Error& error) {
        ++refused;
        REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
      }
    }
  CHECK(refused > trials / 2);
}

}  // namespace mesh_faults_test
