// Frames: sequences of grids that are swept, and lights that move from one timed run to the next.
#include <catch2/catch.hpp>

#include "experiments/application/json_value.h"
#include "experiments/driver/run.h"
#include "scene/media/voxel_grid.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace frames_test {

using namespace airlight;
using namespace airlight::experiments;
using namespace airlight::test;
namespace fs = std::filesystem;

namespace {

const std::string smoke = R"([film]
width = 8
height = 6
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
[[light]]
type = "point"
position = [2, 2, 2]
intensity = 5
[[medium]]
type = "grid"
file = "smoke_####.vdb"
frame = 7
)";

const std::string experiment = R"(title = "Smoke"
layer = "airlight"
metrics = ["rel_l2"]
[[scene]]
name = "smoke"
file = "scenes/one.toml"
sweep = { key = "medium.0.frame", values = [7, 12] }
[reference]
renderer = "deterministic"
settings = { relative_tolerance = 1e-4 }
[[method]]
renderer = "ray_marcher"
[profile.quick]
budget = 0
)";

Outcome run_of(const SmallProject& project) {
  return run_experiment(read_experiment(project.path(), "g/e", "quick"), {project.path(), false, 1, false});
}

}  // namespace

TEST_CASE("a sequence is swept by its frames and shown with a slider", "[driver]") {
  const SmallProject project(smoke, experiment);
  for (const auto& [frame, density] : {std::pair{"0007", 0.2f}, {"0012", 0.6f}}) {
    scene::VoxelGrid grid;
    grid.size = {2, 2, 2};
    grid.voxel_size = 1;
    grid.translation = {-0.5, -0.5, -0.5};
    grid.values.assign(8, density);
    scene::write_vdb((project.path() / "experiments/scenes/smoke_").string() + frame + ".vdb", grid, "density");
  }
  const Outcome outcome = run_of(project);
  REQUIRE(outcome.rows.size() == 2);
  CHECK(outcome.rows[0].scene == "smoke 7");
  CHECK(outcome.rows[1].parameter == 12.0);
  CHECK(outcome.rows[0].scene_hash != outcome.rows[1].scene_hash);
  for (const Row& row : outcome.rows) CHECK(quantity(row, "rel_l2").value().value < 0.02);
  const auto record = nlohmann::json::parse(read_bytes(project.file("results/g/e/run.json")));
  REQUIRE(record["pictures"].size() == 2);
  CHECK(record["pictures"][1]["sequence"] == "smoke");
  CHECK(record["pictures"][1]["frame"] == 12);
  CHECK(record["pictures"][1]["frame_is"] == "frame");
  const Result report = run_command(
      "'" + root + "/scripts/report' --results results --out page.html --program '" + program + "'", project);
  CHECK(report.err == "");
  const std::string page = read_bytes(project.file("page.html"));
  CHECK_THAT(page, Catch::Contains("<div class=sequence><h3>smoke</h3>") && Catch::Contains("type=range min=0 max=1") &&
                       Catch::Contains("data-frame=\"7\"") && Catch::Contains("data-frame=\"12\""));
}

TEST_CASE("a light that turns is shown with a slider, too", "[driver]") {
  const SmallProject project(R"([film]
width = 8
height = 6
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
[[light]]
type = "environment"
sh = [[1, 1, 1]]
rotation = { axis = [0, 1, 0], angle = 0 }
)",
                             R"(title = "Turns"
layer = "mean"
metrics = []
[[scene]]
name = "sky, angle"
file = "scenes/one.toml"
sweep = { key = "light.0.rotation.angle", values = [0, 1.5] }
[[method]]
renderer = "ray_marcher"
[profile.quick]
budget = 0
)");
  run_of(project);
  const auto record = nlohmann::json::parse(read_bytes(project.file("results/g/e/run.json")));
  REQUIRE(record["pictures"].size() == 2);
  CHECK(record["pictures"][1]["sequence"] == "sky, angle");
  CHECK(record["pictures"][1]["frame"] == 1.5);
  run_command("'" + root + "/scripts/report' --results results --out page.html --program '" + program + "'", project);
  CHECK_THAT(read_bytes(project.file("page.html")),
             Catch::Contains("<label>angle <input") && Catch::Contains("data-frame=\"1.5\""));
}

// Times of next frames have their stages; a method that would prepare anew says so.
TEST_CASE("lights that move are timed frame by frame", "[driver]") {
  SmallProject project(box_of_fog(16, 12) + R"([[surface]]
type = "box"
lo = [-0.3, -0.3, -0.3]
hi = [0.3, 0.3, 0.3]
)",
                       R"(title = "Moving"
layer = "airlight"
metrics = ["rel_l2"]
stages = true
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "shadow_planes"
settings = { nodes = 64 }
[[method]]
name = "moving"
renderer = "shadow_planes"
moving = { what = "lights" }
[[method]]
name = "quadrature"
renderer = "deterministic"
moving = { what = "lights" }
[profile.quick]
runs = 3
)");
  const Outcome outcome = run_of(project);
  REQUIRE(outcome.rows.size() == 2);
  const Row& moving = outcome.rows[0];
  CAPTURE(moving.note);
  CHECK(quantity(moving, "rel_l2").value().value < 1e-6);  // of the scene as it is, after there and back
  REQUIRE(!moving.stages.empty());
  CHECK(moving.stages[0].first == "silhouettes");
  CHECK_THAT(outcome.rows[1].note, Catch::Contains("its lights cannot move"));
}

}  // namespace frames_test
