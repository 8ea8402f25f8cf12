// Media converted for a method: by the driver, with the two errors that its rows have, and by the command line.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "experiments/driver/run.h"
#include "scene/film/film.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"
#include "tests/texts.h"

namespace conversion_test {

using namespace airlight;
using namespace airlight::experiments;
using namespace airlight::test;

namespace {

const std::string experiment_file = R"(title = "Forms"
layer = "airlight"
metrics = ["rel_l2", "converted.rel_l2"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "deterministic"
settings = { relative_tolerance = 1e-5 }
[profile.quick]
runs = 1
[[method]]
name = "as it was"
renderer = "ray_marcher"
[[method]]
name = "grid"
renderer = "ray_marcher"
convert = { to = "grid" }
sweep = { key = "convert.voxels", values = [4, 24] }
)";

// A Gaussian beside a sun.
std::string puff_scene(int width, int height) {
  return fmt::format("[film]\nwidth = {}\nheight = {}\n", width, height) + R"(
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vertical_fov = 0.7
[[light]]
type = "directional"
to_light = [1, 1, 1]
irradiance = 3
[[medium]]
name = "puff"
type = "gaussians"
cutoff = 3
sigma_t = 2
gaussians = [ { center = [0, 0, 0], width = 0.4, amplitude = 1 } ]
)";
}

double measure(const Row& row, const std::string& name) {
  for (const Measure& m : row.measures)
    if (m.name == name) return m.value;
  FAIL("no figure " << name);
  return 0;
}

}  // namespace

TEST_CASE("rows of converted media have two errors, and what the conversion lost and took", "[driver][convert]") {
  const SmallProject project(puff_scene(16, 12), experiment_file);
  const Outcome outcome =
      run_experiment(read_experiment(project.path(), "g/e", "quick"), {project.path(), false, 1, false});
  REQUIRE(outcome.rows.size() == 3);
  const Row &plain = outcome.rows[0], &coarse = outcome.rows[1], &fine = outcome.rows[2];
  CHECK(plain.counters.count("conversion_seconds") == 0);
  CHECK(measure(plain, "rel_l2") == measure(plain, "converted.rel_l2"));
  CHECK((coarse.setting == "4" && fine.setting == "24"));
  CHECK(coarse.scene_hash != fine.scene_hash);
  CHECK(coarse.counters.at("numbers") < fine.counters.at("numbers"));
  CHECK(coarse.counters.at("density_error") > 4 * fine.counters.at("density_error"));
  // The total error falls with the voxels; the ray marcher's own error is small for both.
  CHECK(measure(coarse, "rel_l2") > 4 * measure(fine, "rel_l2"));
  CHECK(measure(coarse, "rel_l2") > 4 * measure(coarse, "converted.rel_l2"));
  for (const Row& row : outcome.rows) CHECK(measure(row, "converted.rel_l2") < 0.015);
}

TEST_CASE("a conversion that is misspelt is refused with file and line", "[experiment][convert]") {
  using Catch::Contains;
  const auto complaint = [](const std::string& convert) {
    const SmallProject project(puff_scene(16, 12), replaced(experiment_file, "{ to = \"grid\" }", convert));
    try {
      read_experiment(project.path(), "g/e", "quick");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(complaint("{ to = \"grit\" }"), Contains("e.toml:17") && Contains("grid"));
  CHECK_THAT(complaint("{ to = \"homogeneous\" }"), Contains("e.toml:17") && Contains("voxels"));
}

TEST_CASE("render and explain convert media, and say what that lost", "[cli][convert]") {
  using Catch::Contains;
  const TemporaryFolder folder;
  const std::string plume =
      "render " + scenes + "plume_sun.toml --override film.width=12 --override film.height=16 --out p.exr";
  const Result fogmap = run(plume + " --method ray_marcher --convert to=fogmap,cells=8", folder);
  CAPTURE(fogmap.err);
  CHECK(fogmap.code == 0);
  CHECK_THAT(fogmap.err, Contains("as to=fogmap cells=8") && Contains("relative L2 error of the density"));
  const scene::Film film = scene::read_exr(folder.file("p.exr"));
  CHECK(film.metadata.at("converted") == "to=fogmap,cells=8");
  const Result explained =
      run("explain " + scenes + "plume_sun.toml --method legendre_fluids --convert to=legendre,order=4", folder);
  CHECK_THAT(explained.out, Contains("legendre"));
  for (const char* wrong : {"fogmap", "to=fogmap,count=3", "count=3", "to=fogmap,cells=x", "to=fogmap,"}) {
    CAPTURE(wrong);
    const Result refused = run(plume + " --method ray_marcher --convert " + wrong, folder);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Contains("--convert"));
  }
}

TEST_CASE("media that cannot be converted are a row that says why", "[driver][convert]") {
  std::string endless = puff_scene(8, 6);
  endless += "[[medium]]\ntype = \"homogeneous\"\nname = \"haze\"\nsigma_t = 0.1\nalbedo = 0.5\n";
  const SmallProject project(endless, experiment_file);
  const Outcome outcome =
      run_experiment(read_experiment(project.path(), "g/e", "quick"), {project.path(), false, 1, false});
  REQUIRE(outcome.rows.size() == 3);
  CHECK(outcome.rows[0].note.empty());
  for (int i : {1, 2})
    CHECK(outcome.rows[std::size_t(i)].note ==
          "not supported: medium 'haze' has no end: a conversion needs one with an end in all directions");
}

TEST_CASE("an experiment takes over scenes and methods of another", "[driver]") {
  const SmallProject project(puff_scene(8, 6), experiment_file);
  const std::string top = R"(title = "Alike"
layer = "transmittance"
metrics = ["rel_l2"]
[reference]
renderer = "deterministic"
[[method]]
name = "own"
renderer = "ray_marcher"
)";
  project.write("experiments/g/like.toml", top + "[like]\nexperiment = \"g/e\"\nwithout = [\"as it was\"]\n");
  const Experiment e = read_experiment(project.path(), "g/like", "quick");
  REQUIRE(e.scenes.size() == 1);
  REQUIRE(e.methods.size() == 3);
  CHECK((e.methods[0].name == "own" && e.methods[1].name == "grid" && e.methods[2].setting == "24"));
  CHECK(e.layer == "transmittance");
  project.write("experiments/g/like.toml", top + "[like]\nexperiment = \"g/e\"\nwithout = [\"nobody\"]\n");
  CHECK_THROWS_WITH(read_experiment(project.path(), "g/like", "quick"),
                    Catch::Contains("like.toml:11:11") && Catch::Contains("g/e has no method 'nobody'"));
  project.write("experiments/g/like.toml",
                top + "[like]\nexperiment = \"g/e\"\nwithout = [\"as it was\"]\ndevice = true\n");
  const Experiment on_device = read_experiment(project.path(), "g/like", "quick");
  REQUIRE(on_device.methods.size() == 3);
  CHECK(on_device.methods[0].renderer == "ray_marcher");  // this file's own stays on the processor
  for (std::size_t i = 1; i < 3; ++i) CHECK(on_device.methods[i].renderer == e.methods[i].renderer + "_gpu");
  project.write("experiments/g/traced.toml",
                "title = \"Traced\"\nmetrics = []\n[[scene]]\nfile = \"scenes/one.toml\"\n"
                "[[method]]\nrenderer = \"path_tracer\"\n");
  project.write("experiments/g/like.toml", top + "[like]\nexperiment = \"g/traced\"\ndevice = true\n");
  CHECK_THROWS_WITH(read_experiment(project.path(), "g/like", "quick"),
                    Catch::Contains("like.toml:11:10") && Catch::Contains("no renderer 'path_tracer_gpu'"));
  project.write("experiments/g/like.toml", top + "[like]\nexperiment = \"g/none\"\n");
  CHECK_THROWS_WITH(read_experiment(project.path(), "g/like", "quick"), Catch::Contains("g/none"));
}

}  // namespace conversion_test
