// Pictures of a sequence: films below each other, what changes between them, and an experiment of its own kind.
#include "experiments/driver/sequence_images.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/driver/experiment.h"
#include "experiments/driver/run.h"
#include "scene/base/error.h"
#include "tests/experiments/noisy_films.h"
#include "tests/experiments/small_project.h"

namespace sequence_images_test {

using namespace airlight;
using namespace airlight::experiments;
using namespace airlight::test;

namespace {

constexpr int width = 12, height = 8;

// A picture that grows by a tenth from frame to frame.
Film picture(int frame, double offset = 0) {
  return exact(width, height, [=](int x, int y, int c) { return gradient(x, y, c) * (1 + 0.1 * frame) + offset; });
}

Film noisy_picture(int frame) {
  return noisy(
      width, height, [=](int x, int y, int c) { return gradient(x, y, c) * (1 + 0.1 * frame); }, 0.05,
      unsigned(frame + 1));
}

double flicker_of(const std::vector<Film>& image, const std::vector<Film>& truth) {
  return measure({"rel_l2"}, changes(image, "mean"), changes(truth, "mean"), "mean", {}, ImageNoise::removed)
      .front()
      .value;
}

const std::string moving_fog = R"(kind = "sequence"
title = "Moving"
metrics = ["rel_l2", "flicker"]
[reference]
renderer = "deterministic"
settings = { relative_tolerance = 1e-8 }
[[scene]]
name = "thicker"
file = "scenes/one.toml"
frames = { count = 4, key = "medium.0.sigma_t", first = 1, step = 2 }
[[scene]]
name = "lamp"
file = "scenes/one.toml"
frames = { count = 3, move = [0.3, 0, 0.1] }
[[method]]
name = "itself"
renderer = "deterministic"
settings = { relative_tolerance = 1e-8 }
[[method]]
name = "march"
renderer = "ray_marcher"
[[method]]
name = "anew"
renderer = "ray_marcher"
anew = true
[[method]]
name = "refused"
renderer = "wavelet_fog"
)";

}  // namespace

TEST_CASE("sequence: films below each other, and their changes", "[experiments][sequence]") {
  const std::vector<Film> films{picture(0), picture(1), picture(3)};
  const Film all = stacked(films);
  CHECK((all.width == width && all.height == 3 * height));
  CHECK((all.get("mean", 5, height + 2) == films[1].get("mean", 5, 2)).all());
  const Film change_film = changes(films, "mean");
  CHECK(change_film.height == 2 * height);
  CHECK(change_film.get("mean", 3, height + 1)[0] == Approx(0.2 * gradient(3, 1, 0)).epsilon(1e-5));
  // Sizes 1, 1.1, 1.3 change by 0.1 and 0.2; a mean over three pictures stands beside one over two.
  CHECK(change(films, "mean") == Approx(std::sqrt((0.01 + 0.04) / 2 / ((1 + 1.21 + 1.69) / 3))).epsilon(1e-5));
  CHECK_THROWS_AS(changes({picture(0)}, "mean"), Error);
}

TEST_CASE("sequence: an error that stays does not flicker, one that grows with the picture does as it does",
          "[experiments][sequence]") {
  const std::vector<Film> truth{picture(0), picture(1), picture(2)};
  CHECK(flicker_of({picture(0, 0.5), picture(1, 0.5), picture(2, 0.5)}, truth) == Approx(0).margin(1e-5));
  CHECK(flicker_of({picture(0), picture(0), picture(0)}, truth) ==
        Approx(1).epsilon(1e-6));  // nothing of the change is shown
  CHECK(flicker_of({picture(0), picture(2), picture(4)}, truth) == Approx(1).epsilon(1e-5));  // twice the change
}

TEST_CASE("sequence: the noise of the reference is taken out of flicker and of the change", "[experiments][sequence]") {
  std::vector<Film> truth, image, clean;
  for (int frame = 0; frame < 4; ++frame) {
    truth.push_back(noisy_picture(frame));
    image.push_back(picture(frame / 2 * 2));
    clean.push_back(picture(frame));
  }
  const Measure found =
      measure({"rel_l2"}, changes(image, "mean"), changes(truth, "mean"), "mean", {}, ImageNoise::removed).front();
  const double expected = flicker_of(image, clean);
  CHECK(found.low <= expected);
  CHECK(found.high >= expected);
  CHECK(found.floor > 0.1);
  CHECK(change(truth, "mean") == Approx(change(clean, "mean")).epsilon(0.1));
}

TEST_CASE("sequence: an experiment judges every picture by its own reference", "[experiments][sequence]") {
  const SmallProject project(box_of_fog(12, 8), moving_fog);
  const Outcome outcome =
      run_experiment(read_experiment(project.path(), "g/e", "quick"), {project.path(), false, 1, false});
  REQUIRE(outcome.rows.size() == 8);
  REQUIRE(outcome.references.size() == 2);
  for (const Row& row : outcome.rows) {
    INFO(row.scene << " " << row.method);
    if (row.method == "refused") {
      CHECK(row.note.find("not supported") == 0);
      continue;
    }
    const bool lamp = row.scene == "lamp";
    CHECK(row.runs == (lamp ? 2 : 3));
    CHECK(row.seconds.value > 0);
    CHECK(row.counters.at("change") > 0.01);
    const double error = row.measures.at(0).value, flicker = row.measures.at(1).value;
    if (row.method == "itself") CHECK((error == 0 && flicker == 0));
    if (row.method == "march") CHECK((error > 0 && error < 0.02 && flicker < 0.1));
    if (row.method == "anew") CHECK(row.counters.at("prepared anew") == row.runs);
  }
  CHECK(outcome.rows[1].measures[0].value == outcome.rows[2].measures[0].value);  // the next picture is that made anew
}

TEST_CASE("sequence: a file that cannot be is refused with its place", "[experiments][sequence]") {
  const auto refused = [](const std::string& from, const std::string& to) {
    std::string text = moving_fog;
    text.replace(text.find(from), from.size(), to);
    const SmallProject project(box_of_fog(12, 8), text);
    try {
      const Experiment e = read_experiment(project.path(), "g/e", "quick");
      check_experiment(e, {project.path(), false, 1, false});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refused("move = [0.3, 0, 0.1]", "turn = 1"), Catch::Contains("nothing changes from picture to picture"));
  CHECK_THAT(refused("count = 3", "count = 1"), Catch::Contains("count"));
  CHECK_THAT(refused("\"flicker\"", "\"flip\""), Catch::Contains("'flip' is not known of sequences"));
  CHECK_THAT(refused("anew = true", "moving = { what = \"lights\" }"), Catch::Contains("moving"));
  CHECK_THAT(refused("frames = { count = 3, move = [0.3, 0, 0.1] }", ""), Catch::Contains("frames"));
}

}  // namespace sequence_images_test
