// airlight author: scripts as users write them, good and bad.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "experiments/authoring/script.h"
#include "experiments/authoring/write_scene.h"
#include "scene/base/error.h"
#include "scene/convert/gaussian_fit.h"
#include "scene/convert/residual_file.h"
#include "scene/film/grey_image.h"
#include "scene/media/voxel_grid.h"
#include "scene/scene.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace author_test {

using airlight::Error;
using airlight::read_bytes;
using airlight::TemporaryFolder;
using namespace airlight::experiments::authoring;
using Catch::Contains;

namespace {

const std::string view = R"({"op": "view", "position": [0, 0, 5], "look_at": [0, 0, 0]})";
const std::string stroke = R"({"op": "paint", "stroke": [[0,0,0],[1,0,0]], "a": 5, "c": 1, "seed": 4})";

Authored run(const TemporaryFolder& folder, const std::string& script) {
  folder.write("s.jsonl", script);
  return run_script(folder.file("s.jsonl"), [] {});
}

}  // namespace

TEST_CASE("every operation of a script", "[authoring]") {
  const TemporaryFolder folder;
  folder.write("steam.csv",
               "frame,id,x,y,z,radius,density\n1,7,0,0,0,0.5,2\n1,8,0,1,0,0.5,2\n3,7,4,0,0,1.5,1\n3,9,0,0,0,1,1\n");
  const Authored a = run(folder, view + "\n# a comment\n\n" + stroke + R"(
{"op": "paint", "screen": [[400, 300], [500, 300]], "plane": {"normal": [0,0,1], "d": -1}, "a": 2, "c": 1, "jitter": 0, "tag": "far"}
{"op": "select", "rect": [0, 0, 800, 600]}
{"op": "copy", "transform": {"translation": [0, 3, 0]}}
{"op": "undo"}
{"op": "move", "tag": "far", "transform": {"scale": 2, "rotation": {"axis": [0,1,0], "angle": 1}}, "keep": "density"}
{"op": "emit", "pos": [0,0,0], "rate": 10, "v0": [0,1,0], "life": 1, "a0": 3, "c0": 1, "t1": 5, "time": 2.05, "color": [1, 0.5, 0.2]}
{"op": "airbrush", "pos": [0,0,0], "rate": 10, "speed": 1, "diffusion": 0.1, "dt": 0.1, "steps": 10, "a": 3, "c": 1}
{"op": "freeze"}
{"op": "import", "file": "steam.csv", "frame": 1.5, "color": 0.5}
{"op": "erase", "path": [[0, 0, 0]], "radius": 0.1, "strength": 0.5}
)");
  std::map<std::string, std::size_t> touched;
  for (const auto& done : a.done) touched[done.operation] += done.touched.size();
  // floor(1 / 0.15) + 1 on the stroke; the ray at pixel 500 meets the plane z = -1 at 6 * tan(0.35) / 3 = 0.73.
  CHECK(touched["paint"] == 7 + 2);
  CHECK(touched["select"] == 9);
  CHECK(touched["copy"] == 9);
  CHECK(touched["move"] == 2);
  CHECK(touched["emit"] == 10);
  CHECK(touched["airbrush"] == 10);
  CHECK(touched["freeze"] == 10);
  CHECK(touched["import"] == 3);
  CHECK(a.list.all().size() == 9 + 10 + 10 + 3);
  const auto& imported = a.list.all()[29];
  CHECK(imported.b == airlight::Point3(1, 0, 0));  // a quarter of the way from frame 1 to frame 3
  CHECK(imported.a == 1 / 0.75);
  CHECK(imported.c == 1.75);
  // One that frame 3 has no more, three quarters of what it was; one that frame 1 has not yet, a quarter of what it will be.
  CHECK(a.list.all()[30].b == airlight::Point3(0, 1, 0));
  CHECK(a.list.all()[30].c == 1.5);
  CHECK(a.list.all()[31].b == airlight::Point3(0, 0, 0));
  CHECK(a.list.all()[31].a == 1);
  CHECK(a.list.all()[31].c == 0.125);  // half of it: the eraser was there

  // Three colours, three media; the loader gives back the list.
  const SceneFiles files = scene_files(a, folder.file("s.jsonl"), folder.file("out.toml"));
  REQUIRE(files.tables.size() == 3);
  write(files, folder.file("out.toml"));
  const auto scene = airlight::scene::load_scene(folder.file("out.toml"));
  REQUIRE(scene.media.size() == 3);
  CHECK(scene.width == 800);
  CHECK((scene.media[1].albedo == airlight::Rgb(1, 0.5, 0.2)).all());
  std::size_t at = 0;
  std::vector<airlight::scene::Gaussian> all;
  for (const auto& medium : scene.media) {
    CHECK((medium.sigma_t == 1).all());
    for (const auto& g : std::get<airlight::scene::GaussianSum>(medium.field).gaussians) all.push_back(g);
  }
  REQUIRE(all.size() == a.list.all().size());
  for (const airlight::Rgb& color : {airlight::Rgb(1, 1, 1), airlight::Rgb(1, 0.5, 0.2), airlight::Rgb(0.5, 0.5, 0.5)})
    for (const auto& g : a.list.all()) {
      if (!(g.color == color).all()) continue;
      CHECK(all[at].center == g.b);
      CHECK(all[at].width == 1 / g.a);
      CHECK(all[at++].amplitude == g.c);
    }
  CHECK(at == all.size());
}

TEST_CASE("a base scene is kept, its files found from elsewhere", "[authoring]") {
  const TemporaryFolder folder;
  const std::string base = R"(# é: a comment
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
[[light]]
type = "point"
position = [0, 1, 0]
intensity = 3
[[medium]]
type = "gaussians"
name = "é"
file = "old.csv" # kept
[[surface]]
type = "plane"
)";
  folder.write("in/base.toml", base + "point = [0, -1, 0]\n");
  folder.write("in/old.csv", "center_x,center_y,center_z,width,amplitude\n0,0,0,1,1\n");
  folder.write("in/s.jsonl", "{\"op\": \"scene\", \"base\": \"base.toml\"}\n" + stroke + "\n");
  const Authored a = run_script(folder.file("in/s.jsonl"), [] {});
  for (const std::string out : {"in/out.toml", "elsewhere/deep/out.toml"}) {
    std::filesystem::create_directories(std::filesystem::path(folder.file(out)).parent_path());
    write(scene_files(a, folder.file("in/s.jsonl"), folder.file(out)), folder.file(out));
    const auto scene = airlight::scene::load_scene(folder.file(out));
    CHECK(scene.media.size() == 2);
    CHECK(scene.media[0].name == "é");
    CHECK(scene.lights.size() == 1);
    CHECK(scene.surfaces.size() == 1);
  }
  CHECK_THAT(read_bytes(folder.file("elsewhere/deep/out.toml")), Contains("file = \"../../in/old.csv\" # kept"));
  CHECK_THROWS_WITH(scene_files(a, folder.file("in/s.jsonl"), folder.file("in/base.toml")), Contains("base scene"));
}

// Whatever key names the file: pictures of a backdrop, frames of a sequence, both files of a fitted grid.
TEST_CASE("all files of a base scene are found from elsewhere", "[authoring]") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "in");
  airlight::scene::write_grey_image(folder.file("in/picture.png"), {2, 1, {0.25, 0.75}, ""});
  airlight::scene::write_grey_image(folder.file("in/far.png"), {2, 1, {0.5, 1}, ""});
  airlight::scene::VoxelGrid grid;
  grid.size = {2, 2, 2};
  grid.voxel_size = 1;
  grid.values.assign(8, 0.5f);
  airlight::scene::write_vdb(folder.file("in/smoke.0003.vdb"), grid);
  airlight::scene::GaussianSum sum;
  sum.cutoff = airlight::scene::fit_cutoff;
  sum.gaussians = {{{1, 1, 1}, 0.5, 0.4}};
  airlight::scene::write_residual(folder.file("in/fit.0003.residual"),
                                  airlight::scene::residual_of(grid, sum, {1, {}, true}));
  folder.write("in/fit.0003.csv", "center_x,center_y,center_z,width,amplitude\n1,1,1,0.5,0.4\n");
  folder.write("in/base.toml", R"([camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
[backdrop]
image = "picture.png"
depth = "far.png"
[[medium]]
type = "grid"
file = "smoke.####.vdb"
frame = 3
[[medium]]
type = "fitted"
gaussians = "fit.####.csv"
residual = "fit.####.residual"
frame = 3
)");
  folder.write("in/s.jsonl", "{\"op\": \"scene\", \"base\": \"base.toml\"}\n" + stroke + "\n");
  const Authored a = run_script(folder.file("in/s.jsonl"), [] {});
  std::filesystem::create_directories(folder.path() / "else\"where\n\\");
  const std::string out = folder.file("else\"where\n\\/a\"b\\c\nd.toml");  // and names that need escapes
  write(scene_files(a, folder.file("in/s.jsonl"), out), out);
  const auto scene = airlight::scene::load_scene(out);
  CHECK(scene.media.size() == 3);
  CHECK(scene.backdrops.size() == 1);
}

TEST_CASE("a scene that could not be read is not written", "[authoring]") {
  const TemporaryFolder folder;
  const std::string far = R"({"op": "view", "position": [1e300, 0, 5], "look_at": [0, 0, 0]})";
  const std::string wide = R"({"op": "paint", "stroke": [[0,0,0]], "a": 1e-300, "c": 1})";
  for (const std::string& script : {far + "\n" + stroke, view + "\n" + wide}) {
    const Authored a = run(folder, script);
    CHECK_THROWS_WITH(write(scene_files(a, folder.file("s.jsonl"), folder.file("a.toml")), folder.file("a.toml")),
                      Catch::StartsWith(folder.file("a.toml") + ": not written, since no command could read it: "));
    CHECK(folder.entries() == 1);
  }
}

TEST_CASE("between frames of a fit Gaussians go over by their ids", "[authoring]") {
  const TemporaryFolder folder;
  const auto table = [&](int frame, std::vector<int> ids, std::vector<airlight::scene::Gaussian> gaussians) {
    airlight::scene::GaussianFit fit;
    fit.ids = ids;
    fit.sum.gaussians = gaussians;
    airlight::scene::write_gaussians_csv(folder.file(fmt::format("fit/puff_{:03}.csv", frame)), fit);
  };
  std::filesystem::create_directories(folder.file("fit"));
  table(8, {4, 7}, {{{0, 0, 0}, 0.5, 2}, {{1, 0, 0}, 0.25, 1}});
  table(12, {9, 4}, {{{3, 0, 0}, 1, 4}, {{0, 4, 0}, 1.5, 6}});
  table(1012, {}, {});
  folder.write("fit/puff_0012.csv", "not a frame: a leading zero too many\n");
  folder.write("fit/puff_12.residual", "not a table\n");
  const auto imported = [&](double frame) {
    const Authored a =
        run(folder,
            fmt::format("{}\n{{\"op\": \"import\", \"file\": \"fit/puff_###.csv\", \"frame\": {}}}\n", view, frame));
    return a.list.all();
  };

  const auto first = imported(8);
  REQUIRE(first.size() == 2);
  CHECK(first[0].a == 2);
  CHECK(first[0].c == 2);
  CHECK(first[1].b == airlight::Point3(1, 0, 0));
  CHECK(first[1].a == 4);
  // A quarter of the way: 4 moves, 7 goes, 9 comes.
  const auto between = imported(9);
  REQUIRE(between.size() == 3);
  CHECK(between[0].b == airlight::Point3(0, 1, 0));
  CHECK(between[0].a == 1 / 0.75);
  CHECK(between[0].c == 3);
  CHECK(between[1].b == airlight::Point3(1, 0, 0));
  CHECK(between[1].c == 0.75);
  CHECK(between[2].b == airlight::Point3(3, 0, 0));
  CHECK(between[2].a == 1);
  CHECK(between[2].c == 1);
  CHECK(imported(12).size() == 2);
  CHECK(imported(12)[0].c == 6);
  // Into an empty frame, 1000 on.
  REQUIRE(imported(512).size() == 2);
  CHECK(imported(512)[1].c == 2);
  CHECK(imported(1012).empty());

  const auto refused = [&](const std::string& file, double frame, const std::string& words) {
    const std::string script = fmt::format("{{\"op\": \"import\", \"file\": \"{}\", \"frame\": {}}}\n", file, frame);
    CHECK_THROWS_WITH(run(folder, view + "\n" + script), Contains(":2: ") && Contains(words));
  };
  refused("fit/puff_###.csv", 7.5, "frame = 7.5, expected one from 8 to 1012");
  refused("fit/puff_###.csv", 1013, "expected one from 8 to 1012");
  refused("fit/other_###.csv", 8, "other_###.csv: there is no file of this name");
  refused("none/puff_###.csv", 8, "there is no file of this name");
  refused("fit/p#ff_###.csv", 8, "in one place");
  folder.write("fit/puff_013.csv", "center_x,center_y,center_z,width,amplitude\n0,0,0,1,1\n");
  refused("fit/puff_###.csv", 12.5, "puff_013.csv:1:1: found no ids");
  CHECK(imported(9).size() == 3);  // what is not asked for may be wrong
  folder.write("fit/puff_013.csv", "id,center_x,center_y,center_z,width,amplitude\n5,0,0,0,1,1\n5,0,0,0,1,1\n");
  refused("fit/puff_###.csv", 13, "id 5 is twice");
  folder.write("fit/puff_013.csv", "id,center_x,center_y,center_z,width,amplitude\n5,0,0,0,1,-1\n");
  refused("fit/puff_###.csv", 13, "id 5: amplitude = -1, expected a number >= 0");
  folder.write("fit/puff_013.csv", "id,center_x,center_y,center_z,width,amplitude\n5,0,0,0,1\n");
  refused("fit/puff_###.csv", 13, "puff_013.csv:2:");
}

TEST_CASE("bad scripts are one line with the place, and leave nothing", "[authoring][cli]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& line, const std::string& says) {
    CAPTURE(line);
    const std::string what = airlight::test::message_of([&] { run(folder, view + "\n" + line + "\n"); }, "accepted");
    CHECK_THAT(what, Catch::StartsWith(folder.file("s.jsonl") + ":2: ") && Contains(says));
    CHECK(what.size() < 700);
  };
  refused("{", "not JSON");
  refused("[1, 2]", "expected an object");
  refused("{\"op\": \"paint\", \"a\": NaN}", "not JSON");
  refused(airlight::test::replaced(stroke, "\"paint\"", "\"pant\""), "nearest: paint");
  refused(airlight::test::replaced(stroke, "\"a\"", "\"aa\""), "unknown key 'aa'");
  refused(airlight::test::replaced(stroke, "\"a\": 5", "\"a\": 5, \"a\": 6"), "twice");
  refused(airlight::test::replaced(stroke, "\"a\": 5, ", ""), "missing key 'a'");
  refused(airlight::test::replaced(stroke, "\"a\": 5", "\"a\": -5"), "a = -5, expected a number > 0");
  refused(airlight::test::replaced(stroke, "\"a\": 5", "\"a\": 0"), "expected a number > 0");
  refused(airlight::test::replaced(stroke, "\"a\": 5", "\"a\": \"5\""), "expected a number > 0");
  refused(airlight::test::replaced(stroke, "\"a\": 5", "\"a\": 1e999"), "not JSON");
  refused(airlight::test::replaced(stroke, "\"c\": 1", "\"c\": -1"), "c = -1");
  refused(airlight::test::replaced(stroke, "\"seed\": 4", "\"seed\": -4"), "seed = -4, expected an integer from 0");
  refused(airlight::test::replaced(stroke, "\"seed\": 4", "\"seed\": 4.5"), "seed = 4.5");
  refused(airlight::test::replaced(stroke, "\"seed\": 4", "\"spacing\": 1e-9"), "more than 1000000 points");
  refused(airlight::test::replaced(stroke, "\"seed\": 4", "\"jitter\": -1"), "jitter = -1");
  refused(airlight::test::replaced(stroke, "\"seed\": 4", "\"color\": [0.5, 2, 0]"), "in [0, 1]");
  refused(airlight::test::replaced(stroke, "[1,0,0]", "[1,0]"), "points of 3 finite numbers");
  refused(airlight::test::replaced(stroke, "\"stroke\": [[0,0,0],[1,0,0]]", "\"stroke\": []"), "1 to 100000 points");
  refused(airlight::test::replaced(stroke, "\"stroke\": [[0,0,0],[1,0,0]]", "\"screen\": [[1, 1]]"), "plane");
  refused(R"({"op": "paint", "screen": [[1, 1]], "plane": {"normal": [0,0,1], "d": 9}, "a": 1, "c": 1})", "no point");
  refused(R"({"op": "paint", "screen": [[1, 1]], "plane": {"normal": [0,0,0], "d": 9}, "a": 1, "c": 1})", "zero");
  refused(R"({"op": "erase", "path": [[0,0,0]], "radius": 0})", "radius = 0");
  refused(R"({"op": "erase", "path": [[0,0,0]], "radius": 1, "strength": 1.5})", "strength = 1.5");
  refused(R"({"op": "erase", "radius": 1})", "exactly one");
  refused(R"({"op": "select", "rect": [0, 0, 0, 9]})", "x0 < x1");
  refused(R"({"op": "copy", "ids": [3], "transform": {}})", "no Gaussian has the id 3");
  refused(R"({"op": "copy", "tag": "x", "transform": {}})", "the tag of a Gaussian");
  refused(R"({"op": "move", "ids": [], "transform": {"scale": 0}})", "scale = 0");
  refused(R"({"op": "move", "ids": [], "transform": {"sclae": 1}})", "nearest: scale");
  const std::string emit =
      R"({"op": "emit", "pos": [0,0,0], "rate": 10, "v0": [0,1,0], "life": 1, "a0": 3, "c0": 1, "t1": 5, "time": 2})";
  refused(airlight::test::replaced(emit, "\"rate\": 10", "\"rate\": 1e8"), "more than 1000000 particles");
  refused(airlight::test::replaced(emit, "\"c0\": 1", "\"c0\": 1, \"c1\": 2"), "c1 = 2");
  refused(airlight::test::replaced(emit, "\"t1\": 5", "\"t1\": -5"), "t1 = -5");
  refused(airlight::test::replaced(emit, "\"life\": 1", "\"life\": 0"), "life = 0");
  const std::string brush =
      R"({"op": "airbrush", "pos": [0,0,0], "rate": 10, "speed": 1, "diffusion": 0, "dt": 0.1, "steps": 10, "a": 3, "c": 1})";
  refused(airlight::test::replaced(brush, "\"rate\": 10", "\"rate\": 1e9"), "more than 1000000 Gaussians");
  refused(airlight::test::replaced(brush, "\"steps\": 10", "\"steps\": 99999999, \"tag\": \"x\""), "more than");
  refused(airlight::test::replaced(brush, "\"steps\": 10", "\"steps\": 99999999999"), "an integer from");
  refused(airlight::test::replaced(airlight::test::replaced(brush, "\"dt\": 0.1", "\"dt\": 0.001"), "\"steps\": 10",
                                   "\"steps\": 10000000"),
          "at most 1e9 moves");
  refused(airlight::test::replaced(brush, "\"dt\": 0.1", "\"dt\": 0"), "dt = 0");
  refused(R"({"op": "freeze", "ids": []})", "unknown key 'ids'");
  refused(R"({"op": "import", "file": "none.csv", "frame": 1})", "none.csv");
  refused(R"({"op": "undo"})", "at most 0");
  refused(R"({"op": "scene", "base": "none.toml"})", "first operation");
  CHECK_THROWS_WITH(run(folder, stroke + "\n" + R"({"op": "scene", "base": "none.toml"})" + "\n"),
                    Contains(":2: ") && Contains("first operation"));
  folder.write("f.csv", "frame,id,x,y,z,radius,density\n1,7,0,0,0,-1,2\n");
  refused(R"({"op": "import", "file": "f.csv", "frame": 1})", "f.csv:2:11: radius = -1, expected a number > 0");
  folder.write("f.csv", "frame,id,x,y,z,radius,density\n1,7,0,0,0,1,2\n");
  refused(R"({"op": "import", "file": "f.csv", "frame": 2})", "from 1 to 1");
  folder.write("f.csv", "frame,id,x,y,z,radius,density\n1,7,0,0,0,1,2\n1,7,0,0,0,1,2\n");
  refused(R"({"op": "import", "file": "f.csv", "frame": 1})", "twice");

  // Through the program: exit code 2, one line, and no file of the output is there.
  const std::string program = std::filesystem::absolute(AIRLIGHT_PROGRAM).string();
  const auto call = [&](const std::string& arguments) {
    const int status = std::system(
        ("cd '" + folder.path().string() + "' && '" + program + "' author " + arguments + " >out.txt 2>err.txt")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  folder.write("bad.jsonl", view + "\n" + stroke + "\n{\"op\": \"pain\"}\n");
  CHECK(call("bad.jsonl -o made.toml") == 2);
  CHECK_THAT(read_bytes(folder.file("err.txt")), Catch::StartsWith("airlight: bad.jsonl:3: ") && Contains("paint"));
  CHECK_FALSE(std::filesystem::exists(folder.file("made.toml")));
  CHECK_FALSE(std::filesystem::exists(folder.file("made.csv")));
  folder.write("good.jsonl", view + "\n" + stroke + "\n");
  CHECK(call("good.jsonl -o no/such/made.toml") == 2);
  CHECK(call("good.jsonl -o made.txt") == 2);
  CHECK(call("good.jsonl -o good.jsonl") == 2);
  CHECK(call("good.jsonl") == 2);
  CHECK(call("good.jsonl -o made.toml") == 0);
  const std::string toml = read_bytes(folder.file("made.toml")), csv = read_bytes(folder.file("made.csv"));
  CHECK(call("good.jsonl -o made.toml") == 0);
  CHECK(toml == read_bytes(folder.file("made.toml")));
  CHECK(csv == read_bytes(folder.file("made.csv")));
  folder.write("none.jsonl", stroke + "\n");
  CHECK(call("none.jsonl -o other.toml") == 2);
  CHECK_THAT(read_bytes(folder.file("err.txt")), Contains("no camera"));
}

}  // namespace author_test
