// Noise and masks in the driver: rows contain the metrics of the pictures.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "experiments/driver/run.h"
#include "scene/renderer.h"
#include "tests/experiments/small_project.h"
#include "tests/texts.h"

namespace driver_noise_test {

using namespace airlight::experiments;
using airlight::test::replaced;

namespace {

// Thin fog in a box, 1 - transmittance from 0 to 2e-3 where the box is in view, and a light with an opaque ball.
const std::string scene_file = R"([film]
width = 24
height = 18
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vertical_fov = 0.7
[[light]]
type = "point"
position = [0.4, 0.3, 1.5]
intensity = 5
radius = 0.2
[[medium]]
type = "homogeneous"
sigma_t = 0.001
region = { type = "sphere", center = [0, 0, 0], radius = 1 }
)";

const std::string experiment_file = R"(title = "Noise"
metrics = ["rel_l2", "bias", "foreground.rel_l2"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "path_tracer"
settings = { samples = 256, max_order = 1 }
[[method]]
name = "exact"
renderer = "ray_marcher"
settings = { kernel = "scalar" }
[[method]]
name = "counted"
renderer = "path_tracer"
settings = { samples = 64, max_order = 1, stream = 1 }
count_noise = true
[[method]]
name = "removed"
renderer = "path_tracer"
settings = { samples = 64, max_order = 1, stream = 1 }
[[method]]
name = "few"
renderer = "path_tracer"
settings = { samples = 4, max_order = 1, stream = 1 }
count_noise = true
[profile.quick]
budget = 0
)";

struct NoiseProject : airlight::test::SmallProject {
  using SmallProject::SmallProject;
  Outcome run() const { return run_experiment(read_experiment(path(), "g/e", "quick"), {path(), false, 1, false}); }
  airlight::scene::Film picture(const std::string& name) const {
    return airlight::scene::read_exr(file("results/images/g/e/one/" + name + ".exr"));
  }
};

const Measure& found(const Row& row, const std::string& metric) {
  for (const Measure& m : row.measures)
    if (m.name == metric) return m;
  throw std::runtime_error("no " + metric);
}

}  // namespace

// The path tracer's own noise is half its error in one row and none of it in the other; the reference's is in no row's
// error and in every row's interval.
TEST_CASE("noise of references and images reaches the rows", "[driver]") {
  // The film is large enough to tell noise from none: most of the noise is in the few lit pixels beside the lamp.
  const std::string larger = replaced(replaced(scene_file, "width = 24", "width = 96"), "height = 18", "height = 72");
  const NoiseProject project(replaced(larger, "0.001", "0.5"), experiment_file);
  const Outcome outcome = project.run();
  REQUIRE(outcome.rows.size() == 4);
  const Row &exact = outcome.rows[0], &counted = outcome.rows[1], &removed = outcome.rows[2], &few = outcome.rows[3];
  for (const Row& row : outcome.rows) {
    CAPTURE(row.method, row.note);
    REQUIRE(row.note.empty());
    for (const Measure& m : row.measures) {
      CHECK(m.floor > 0);
      CHECK(m.high > m.low);
    }
  }
  // 64 samples have twice the noise of 256: counted, the error is twice the floor (which is the reference's); removed,
  // nothing is left above a floor of both together, sqrt(5) times as high.
  const double floor = found(exact, "rel_l2").floor;
  CHECK(found(counted, "rel_l2").floor == Approx(floor).epsilon(1e-6));
  CHECK(found(counted, "rel_l2").value == Approx(2 * floor).epsilon(0.15));
  CHECK_FALSE(found(counted, "rel_l2").below_floor);
  CHECK(found(removed, "rel_l2").floor == Approx(std::sqrt(5) * floor).epsilon(0.15));
  CHECK(found(removed, "rel_l2").value < floor);
  // Four samples have four times the noise of 64, and no batches. Their bias is within their noise, whose standard
  // error is sqrt(256 / 4 + 1) = 8 times that of the exact row.
  CHECK(found(few, "rel_l2").value == Approx(8 * floor).epsilon(0.2));
  const Measure &bias = found(few, "bias"), &sure = found(exact, "bias");
  CHECK(bias.low < 0);
  CHECK(bias.high > 0);
  CHECK(bias.high - bias.low > 4 * (sure.high - sure.low));
}

// Rows are the metrics over the pixels that touch no ball, and for `foreground.` over those that the medium covers:
// what the masks leave out is changed in the pictures, and changes the figures, which are not those of the driver then.
TEST_CASE("rows leave out balls and background", "[driver]") {
  const std::string exact = replaced(replaced(experiment_file, "\"path_tracer\"", "\"deterministic\""),
                                     "{ samples = 256, max_order = 1 }", "{ }");
  std::string one_method =
      exact.substr(0, exact.find("[[method]]\nname = \"counted\"")) + "[profile.quick]\nbudget = 0\n";
  one_method = replaced(one_method, "kernel = \"scalar\"", "kernel = \"scalar\", steps = 2");
  const NoiseProject project(scene_file, one_method);
  const Outcome outcome = project.run();
  REQUIRE(outcome.rows.size() == 1);
  REQUIRE(outcome.rows[0].note.empty());
  const auto image = project.picture("exact"), reference = project.picture("reference");
  const auto scene = airlight::scene::load_scene(project.file("experiments/scenes/one.toml"));
  const auto balls = airlight::scene::ball_mask(scene, airlight::scene::view_of(scene));
  CHECK(std::count(balls.begin(), balls.end(), 1) > 4);
  // 1 - exp(-0.001 times the chord of the unit sphere): a chord above 1, so within sqrt(3)/2 of the middle. Counted
  // along the camera's rays through the centres of pixels; the ball's shadow on the background is left out anyway.
  std::vector<unsigned char> covered(balls.size(), 0);
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 24; ++x) {
      const double up = (1 - 2 * (y + 0.5) / 18) * std::tan(0.35),
                   right = (2 * (x + 0.5) / 24 - 1) * std::tan(0.35) * 24 / 18;
      const double sine2 = (up * up + right * right) / (1 + up * up + right * right);  // of the angle to the axis
      const double off2 = 16 * sine2;  // squared distance from the centre
      const double chord = off2 < 1 ? 2 * std::sqrt(1 - off2) : 0;
      covered[std::size_t(24 * y + x)] = -std::expm1(-0.001 * chord) > 1e-3;
    }
  const int in_front = int(std::count(covered.begin(), covered.end(), 1));
  CHECK((in_front > 50 && in_front < 300));
  const std::function<double(const std::string&, const Masks&)> measured = [&](const std::string& name,
                                                                               const Masks& masks) {
    return measure({name}, image, reference, "mean", masks)[0].value;
  };
  for (const std::string name : {"rel_l2", "bias"}) {
    CAPTURE(name);
    CHECK(found(outcome.rows[0], name).value == measured(name, Masks{balls, covered}));
    CHECK(found(outcome.rows[0], name).value != measured(name, Masks{{}, covered}));
  }
  // All but the ball's pixels, whose rays end before the sphere's far side.
  CHECK(found(outcome.rows[0], "foreground.rel_l2").value == measured("foreground.rel_l2", Masks{balls, covered}));
  std::vector<unsigned char> all(covered.size(), 1);
  CHECK(found(outcome.rows[0], "foreground.rel_l2").value != measured("foreground.rel_l2", Masks{balls, all}));
}

}  // namespace driver_noise_test
