// Files that a scene names: where they are looked for, and what is said of damaged ones.
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "scene/base/data_folder.h"
#include "scene/base/error.h"
#include "scene/base/read_file.h"
#include "scene/scene.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace assets_test {

using namespace airlight;
using namespace airlight::scene;
using test::camera;
using test::message;
namespace fs = std::filesystem;

namespace {

const std::string root = AIRLIGHT_SOURCE_DIR;

}  // namespace

TEST_CASE("files are looked for beside the scene, then in the data folder", "[load]") {
  const TemporaryFolder folder;
  const std::string text = camera + "[[medium]]\ntype = 'gaussians'\nfile = 'data/g.csv'\n";
  const auto scene = [&] { return parse_scene(text, "s.toml", (folder.path() / "scenes").string()); };
  const auto write = [&](const std::string& name, int count) {
    fs::create_directories((folder.path() / name).parent_path());
    std::ofstream stream((folder.path() / name).string());
    stream << "center_x,center_y,center_z,width,amplitude\n";
    for (int i = 0; i < count; ++i) stream << "0,0,0,1,1\n";
  };
  const auto count = [](const Scene& s) { return std::get<GaussianSum>(s.media[0].field).gaussians.size(); };

  CHECK_THROWS_WITH(scene(), Catch::Contains("s.toml:6:8") && Catch::Contains("there is n"));
  CHECK_THROWS_AS(set_data_folder((folder.path() / "nowhere").string()), Error);
  write("shared/data/g.csv", 2);
  set_data_folder((folder.path() / "shared").string());
  CHECK(count(scene()) == 2);
  write("scenes/data/g.csv", 3);
  CHECK(count(scene()) == 3);
  set_data_folder(root);  // for the tests that follow, a folder that stays
}

// Each is told with the place in the scene, the file, and in one line; what precisely is wrong with it is for the tests
// of its reader.
TEST_CASE("damaged files are named together with the place that names them", "[load]") {
  const TemporaryFolder folder;
  const struct {
    const char* name;
    const char* source;
    const char* text;
  } kinds[] = {
      {"a.vdb", "plume_0024.vdb", "[[medium]]\ntype = 'grid'\nfile = 'a.vdb'\n"},
      {"a.exr", "courtyard.exr", "[[light]]\ntype = 'environment'\nfile = 'a.exr'\n"},
      {"a.off", "oblong.off", "[[surface]]\ntype = 'mesh'\nfile = 'a.off'\n"},
  };
  for (const auto& kind : kinds) {
    const std::string whole = read_bytes(root + "/experiments/data/" + kind.source);
    REQUIRE(whole.size() > 1000);
    const std::string path = (folder.path() / kind.name).string();
    const auto with = [&](const std::string& content) {
      std::ofstream(path, std::ios::binary) << content;
      return message(camera + kind.text, folder.path().string());
    };
    CAPTURE(kind.name);
    CHECK(with(whole) == "");
    for (const std::string& content : {std::string(), whole.substr(0, 10), whole.substr(0, whole.size() / 2),
                                       std::string(1000, 'x'), std::string(1000, '\0'), camera}) {
      const std::string what = with(content);
      CAPTURE(content.size(), what);
      CHECK(what.rfind("s.toml:6:8: ", 0) == 0);
      CHECK(what.find(kind.name) != std::string::npos);
      CHECK(what.find('\n') == std::string::npos);
      CHECK(what.size() < 600);
    }
    fs::remove(path);
    fs::create_directory(path);
    CHECK(message(camera + kind.text, folder.path().string()).rfind("s.toml:6:8: ", 0) == 0);
    fs::remove_all(path);
  }
}

TEST_CASE("bad tables of Gaussians name their line and column", "[load]") {
  const TemporaryFolder folder;
  const std::string header = "center_x,center_y,center_z,width,amplitude\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "found an empty file"},
      {"x,y,z\n", ":1:1: found 'x,y,z', expected the header center_x"},
      {header + "0,0,0,1,1\n0,0,0,1\n", ":3:8: found 4 values, expected 5"},
      {header + "0,0,0,1,1,1\n", ":2:10: found more than 5 values"},
      {header + "\n# note\n0,zero,0,1,1\n",
       ":4:3: center_y = zero, expected 0 or a number of either sign, its size in [1e-30, 1e+09]"},
      {header + "0,0,0,0,1\n", ":2:7: width = 0, expected a number in [1e-09, 1e+09]"},
      {header + "0,0,0,1,nan\n",
       ":2:9: amplitude = nan, expected 0 or a number of either sign, its size in [1e-20, 1e+20]"},
      {header + "0,0,0,1,1e999\n",
       ":2:9: amplitude = 1e999, expected 0 or a number of either sign, its size in [1e-20, 1e+20]"},
      {header + "0,0,\xff\x01,1,1\n",
       ":2:5: center_z = ??, expected 0 or a number of either sign, its size in [1e-30, 1e+09]"},
  };
  for (const auto& [content, expected] : cases) {
    std::ofstream((folder.path() / "g.csv").string(), std::ios::binary) << content;
    const std::string what =
        message(camera + "[[medium]]\ntype = 'gaussians'\nfile = 'g.csv'\n", folder.path().string());
    CAPTURE(content, what);
    CHECK(what.find(expected) != std::string::npos);
    CHECK(what.find("g.csv") != std::string::npos);
    CHECK(what.find('\n') == std::string::npos);
  }
}

// Tables as editors, spreadsheets and other programs write them.
TEST_CASE("tables of Gaussians in other spellings", "[load]") {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF", header = "center_x,center_y,center_z,width,amplitude\n",
                    row = "0,0.5,0,1,2\n";
  for (const std::string& content : {mark + header + row, "# made by hand\n" + header + row,
                                     mark + "# made by hand\r\n\r\n" + header + row, header + "+0,+0.5,0,+1,+2e0\n"}) {
    CAPTURE(content);
    folder.write("g.csv", content);
    const Scene scene =
        parse_scene(camera + "[[medium]]\ntype = 'gaussians'\nfile = 'g.csv'\n", "s.toml", folder.path().string());
    const auto& gaussians = std::get<GaussianSum>(scene.media[0].field).gaussians;
    REQUIRE(gaussians.size() == 1);
    CHECK(gaussians[0].center == Point3(0, 0.5, 0));
    CHECK(gaussians[0].amplitude == 2);
  }
  for (const std::string cell : {"+-1", "++1", "+"}) {
    folder.write("g.csv", header + "0,0,0,1," + cell + "\n");
    CHECK(message(camera + "[[medium]]\ntype = 'gaussians'\nfile = 'g.csv'\n", folder.path().string())
              .find(":2:9: amplitude = ") != std::string::npos);
  }
}

TEST_CASE("a # in the name of a folder is no digit of a frame", "[load]") {
  const TemporaryFolder folder;
  const auto copy = [&](const std::string& name) {
    fs::create_directories((folder.path() / name).parent_path());
    fs::copy_file(root + "/experiments/data/plume_0024.vdb", folder.path() / name);
  };
  const auto said = [&](const std::string& keys) {
    return message(camera + "[[medium]]\ntype = 'grid'\n" + keys, folder.path().string());
  };
  copy("take#2/smoke.vdb");
  copy("take#2/smoke_0007.vdb");
  copy("frame_03/smoke.vdb");
  CHECK(said("file = 'take#2/smoke.vdb'\n") == "");
  CHECK(said("file = 'take#2/smoke_####.vdb'\nframe = 7\n") == "");
  CHECK(said("file = 'frame_##/smoke.vdb'\nframe = 3\n") == "");
  CHECK(said("file = 'take#2/smoke_####.vdb'\n").find("is a sequence, expected a frame") != std::string::npos);
}

// A pipe would be waited for, and so would some files of /proc that count as regular.
TEST_CASE("what is no file is refused at once", "[load]") {
  const TemporaryFolder folder;
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"a.vdb", "[[medium]]\ntype = 'grid'\n"},
                                   {"a.csv", "[[medium]]\ntype = 'gaussians'\n"},
                                   {"a.exr", "[[light]]\ntype = 'environment'\n"},
                                   {"a.png", "[[medium]]\ntype = 'fogmap'\n"},
                                   {"a.obj", "[[surface]]\ntype = 'mesh'\n"}}) {
    CAPTURE(name);
    const std::string keys = text + "file = '" + name + "'\n" + (name == "a.png" ? "cell = 1\nsigma_t = 1\n" : "");
    REQUIRE(mkfifo(folder.file(name).c_str(), 0600) == 0);
    CHECK(message(camera + keys, folder.path().string()).find(name + ": ") != std::string::npos);
    fs::remove(folder.path() / name);
    fs::create_symlink("/dev/zero", folder.path() / name);
    CHECK(message(camera + keys, folder.path().string()).find(name + ": ") != std::string::npos);
  }
  if (access("/proc/kmsg", R_OK) == 0) CHECK_THROWS_AS(read_whole_file("/proc/kmsg", 1 << 20), Error);
  REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_whole_file(folder.file("pipe")), Catch::Contains("found a pipe or a device"));
}

TEST_CASE("a scene file that cannot be read says why", "[load]") {
  const auto what = [](const std::string& path) { return test::message_of([&] { load_scene(path); }); };
  const TemporaryFolder folder;
  const std::string empty = (folder.path() / "empty.toml").string();
  std::ofstream{empty};
  CHECK(what("/no/such/scene.toml") == "/no/such/scene.toml: no such file");
  CHECK(what(folder.path().string()) == folder.path().string() + ": found a folder, expected a file");
  CHECK(what(empty) == empty + ": found an empty file");
  // A picture in the place of a scene.
  CHECK(what(std::string(AIRLIGHT_SOURCE_DIR) + "/experiments/data/courtyard.exr").find("expected a text file") !=
        std::string::npos);
}

}  // namespace assets_test
