// simulate and the names that its files get.
#include <catch2/catch.hpp>

#include "tests/experiments/run_program.h"

namespace cli_simulate_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string flow = R"([flow]
duration = 0.2
frame_rate = 10
box = { lo = [0, 0, 0], hi = [1, 1, 1] }
[start]
density = 1
)";

const std::string scene = R"([film]
width = 8
height = 6
[camera]
position = [0.5, 0.5, 4]
look_at = [0.5, 0.5, 0]
[[light]]
type = "directional"
to_light = [0, 1, 0]
irradiance = 1
[[medium]]
type = "homogeneous"
sigma_t = 2
region = { type = "box", lo = [0, 0, 0], hi = [1, 1, 1] }
)";

}  // namespace

TEST_CASE("each solver's frames are drawn without naming a renderer", "[cli][simulation]") {
  const TemporaryFolder folder;
  folder.write("flow.toml", flow);
  folder.write("scene.toml", scene);
  for (const std::string method : {"", " --method stable_fluids --set n=4", " --method legendre_fluids --set n=4"}) {
    CAPTURE(method);
    const Result result = run("simulate flow.toml --scene scene.toml --out frames" + method, folder);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    for (const std::string frame : {"0000", "0001", "0002"})
      CHECK(fs::file_size(folder.path() / "frames" / ("flow." + frame + ".png")) > 60);
    fs::remove_all(folder.path() / "frames");
  }
}

// From the files of the frames, whoever wrote them: without pictures, or with pictures of another scene.
TEST_CASE("frames of an earlier run are drawn, too", "[cli][simulation]") {
  const TemporaryFolder folder;
  folder.write("flow.toml", flow + "blob = [ { center = [0.4, 0.4, 0.5], width = 0.4, density = 1 } ]\n");
  folder.write("scene.toml", scene);
  for (const std::string method : {" --set n=4", " --method legendre_fluids --set n=4"}) {
    CAPTURE(method);
    const std::string simulate = "simulate flow.toml" + method;
    REQUIRE(run(simulate + " --scene scene.toml --out whole", folder).code == 0);
    REQUIRE(run(simulate + " --out later", folder).code == 0);
    folder.write("later/flow.0001.png", "of another scene");
    const Result result = run(simulate + " --scene scene.toml --out later", folder);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    CHECK_THAT(result.out, Contains("3 frames, 3 of them from an earlier run"));
    for (const std::string frame : {"0000", "0001", "0002"})
      CHECK(read_bytes(folder.file("later/flow." + frame + ".png")) ==
            read_bytes(folder.file("whole/flow." + frame + ".png")));
    fs::remove_all(folder.path() / "whole");
    fs::remove_all(folder.path() / "later");
  }
}

TEST_CASE("a flow's name leads nowhere", "[cli][simulation]") {
  const TemporaryFolder folder;
  for (const std::string& name :
       std::vector<std::string>{"../evil", folder.file("evil"), "a/evil", "..", ".", "a\\u0000b", "a\\nb", ""}) {
    CAPTURE(name);
    folder.write("flow.toml", "name = \"" + name + "\"\n" + flow);
    const Result result = run("simulate flow.toml --set n=4 --out out", folder);
    CHECK(result.code == 2);
    CHECK(result.error_lines() == 1);
    CHECK_THAT(result.err, Contains("flow.toml:1:8: name = ") &&
                               Contains("expected a name of 1 to 200 bytes in one line, without '/'"));
    CHECK(folder.entries() == 3);  // the problem and both outputs
  }
}

// Where somebody else may write into the folder, a link could lead to any file of the user's.
TEST_CASE("simulate replaces links in its folder", "[cli][simulation]") {
  const TemporaryFolder folder;
  folder.write("flow.toml", flow);
  folder.write("victim", "mine");
  fs::create_directory(folder.path() / "out");
  for (const std::string name : {"flow.0000.vdb", "history.csv"})
    fs::create_symlink("../victim", folder.path() / "out" / name);
  CHECK(run("simulate flow.toml --set n=4 --out out", folder).code == 0);
  CHECK(read_bytes(folder.file("victim")) == "mine");
  CHECK(fs::is_regular_file(fs::symlink_status(folder.path() / "out/flow.0000.vdb")));
}

}  // namespace cli_simulate_test
