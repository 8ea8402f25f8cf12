// Sequences of smoke: simulated when an experiment asks for them, kept while nothing they depend on changes.
#include "experiments/driver/sequences.h"

#include <catch2/catch.hpp>

#include "experiments/driver/run.h"
#include "scene/base/error.h"
#include "tests/experiments/small_project.h"

namespace sequences_test {

using namespace airlight::experiments;
using airlight::Error;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string smoke = R"([film]
width = 8
height = 8
[camera]
position = [0.5, 0.5, 4]
look_at = [0.5, 0.5, 0]
[[light]]
type = "point"
position = [1.5, 2, 1]
intensity = 5
[[medium]]
type = "grid"
file = "nothing.vdb"
sigma_t = 2
)";

const std::string flow = R"(name = "puff"
[flow]
duration = 0.5
frame_rate = 4
box = { lo = [0, 0, 0], hi = [1, 1, 1] }
[fluid]
gravity = [0, -9.81, 0]
expansion = 0.003
[[start.blob]]
center = [0.5, 0.3, 0.5]
width = 0.2
density = 1
temperature = 30
)";

const std::string frames = R"(title = "Frames"
layer = "airlight"
metrics = ["rel_l2"]
[[scene]]
name = "puff"
file = "scenes/one.toml"
overrides = { "medium.0.file" = "sequence:puff" }
sweep = { key = "medium.0.frame", values = [1, 2] }
[reference]
renderer = "deterministic"
[[method]]
renderer = "ray_marcher"
[[plot]]
name = "mass"
x = "column.time"
y = "column.mass"
per_scene = false
[profile.quick]
budget = 0
)";

struct Frames : airlight::test::SmallProject {
  Frames() : SmallProject(smoke, frames) {
    write("experiments/flows/puff.toml", flow);
    list("n = 8");
  }
  void list(const std::string& settings) const {
    write("experiments/sequences.toml",
          "[puff]\nproblem = \"flows/puff.toml\"\nsolver = \"stable_fluids\"\nquick = { settings = { " + settings +
              " } }\n");
  }
  Experiment read() const { return read_experiment(path(), "g/e", "quick"); }
  fs::path frame(int i) const {
    return path() / ("results/cache/sequences/puff.quick/puff.000" + std::to_string(i) + ".vdb");
  }
};

}  // namespace

TEST_CASE("an experiment makes the sequence that its scenes show", "[driver][flow]") {
  const Frames project;
  const Outcome outcome = run_experiment(project.read(), {project.path(), false, 1, false});
  REQUIRE(outcome.rows.size() == 2);
  CHECK(outcome.rows[0].scene_hash != outcome.rows[1].scene_hash);  // the smoke has moved
  CHECK(outcome.experiment.scenes[0].of_sequence == "frame");
  CHECK(outcome.histories.front().columns.at("time") == std::vector<double>{0, 0.25, 0.5});
  CHECK_THAT(airlight::read_bytes((project.path() / "results/g/e/plots/mass.csv").string()), Contains("puff,0.25,"));
  const auto made = fs::last_write_time(project.frame(2));
  // Nothing is simulated again,
  make_sequence(project.path(), "puff", "quick", 1);
  CHECK(fs::last_write_time(project.frame(2)) == made);
  // but where a frame is gone or the settings are others.
  fs::remove(project.frame(1));
  make_sequence(project.path(), "puff", "quick", 1);
  CHECK(fs::exists(project.frame(1)));
  const std::string before = airlight::read_bytes(project.frame(1).string());
  // Frames that lie in each other's place would give another table.
  fs::rename(project.frame(1), project.path() / "first");
  fs::rename(project.frame(2), project.frame(1));
  fs::rename(project.path() / "first", project.frame(2));
  make_sequence(project.path(), "puff", "quick", 1);
  CHECK(airlight::read_bytes(project.frame(1).string()) == before);
  project.list("n = 12");
  make_sequence(project.path(), "puff", "quick", 1);
  CHECK(airlight::read_bytes(project.frame(1).string()) != before);
}

// In a fresh clone all experiments are checked before the first runs.
TEST_CASE("an experiment of numbers is checked where no sequence has been made", "[driver][flow]") {
  const Frames project;
  project.write("experiments/g/numbers.toml", R"(kind = "numbers"
title = "Numbers"
metrics = ["squared_percent"]
[[scene]]
name = "puff"
file = "scenes/one.toml"
overrides = { "medium.0.file" = "sequence:puff", "medium.0.frame" = 1 }
[[method]]
name = "fit"
probe = "gaussian_fit"
settings = { smoke = "scene", gaussians = 3 }
)");
  REQUIRE_FALSE(fs::exists(project.frame(1)));
  check_experiment(read_experiment(project.path(), "g/numbers", "quick"), {project.path(), false, 1, false});
  CHECK(fs::exists(project.frame(1)));
}

TEST_CASE("Gaussians are fitted to the frames of a sequence, and again where those or their number change",
          "[driver][flow][gaussian_fit]") {
  const Frames project;
  const auto list = [&](int n, int gaussians) {
    project.list("n = " + std::to_string(n));
    const fs::path file = project.path() / "experiments/sequences.toml";
    project.write("experiments/sequences.toml",
                  airlight::read_bytes(file.string()) +
                      "[fitted]\nfit = \"puff\"\nquick = { gaussians = " + std::to_string(gaussians) + " }\n");
  };
  const auto files = [&](const std::string& kind) {
    std::string pattern = sequence_files(project.path(), "fitted" + kind, "quick", "here");
    return pattern.replace(pattern.find("####"), 4, "0002");
  };
  list(8, 3);
  CHECK_THAT(files(".csv"), Contains("fitted.quick/puff.0002.csv"));
  CHECK_THAT(files(".residual"), Contains("fitted.quick/puff.0002.residual"));
  CHECK_THROWS_WITH(files(""),
                    Contains("here: the sequence 'fitted' has no files .vdb, expected one of .csv, .residual"));
  make_sequence(project.path(), "fitted.csv", "quick", 1);
  const std::string three = airlight::read_bytes(files(".csv"));
  CHECK(fs::exists(project.frame(2)));
  CHECK(fs::exists(files(".residual")));
  const auto history = sequence_history(project.path(), "fitted", "quick");
  CHECK(history.at("frame") == std::vector<double>{0, 1, 2});
  CHECK(history.at("gaussians").size() == 3);
  const auto made = fs::last_write_time(files(".csv"));
  make_sequence(project.path(), "fitted.residual", "quick", 1);
  CHECK(fs::last_write_time(files(".csv")) == made);
  for (const auto& [n, gaussians] : {std::pair(8, 2), std::pair(10, 2)}) {
    const std::string before = airlight::read_bytes(files(".csv"));
    list(n, gaussians);
    make_sequence(project.path(), "fitted", "quick", 1);
    CHECK(airlight::read_bytes(files(".csv")) != before);
  }
  project.write("experiments/sequences.toml", "[fitted]\nfit = \"fitted\"\nquick = { gaussians = 2 }\n");
  CHECK_THROWS_WITH(make_sequence(project.path(), "fitted", "quick", 1),
                    Contains("expected the name of a sequence that is simulated"));
}

// A sequence that is made anew has its folder removed first.
TEST_CASE("a sequence's name leads to no other folder", "[driver][flow]") {
  Frames project;
  project.write("precious/file", "mine");
  for (const std::string& name : {(project.path() / "precious").string(), std::string("../../../precious"),
                                  std::string("a/b"), std::string("a b"), std::string("a.b")}) {
    CAPTURE(name);
    project.write("experiments/sequences.toml", "[\"" + name + "\"]\nproblem = \"flows/puff.toml\"\n");
    const std::string expected =
        "sequences.toml:1:2: found the name '" + name + "', expected letters, digits, '_' and '-'";
    CHECK_THROWS_WITH(make_sequence(project.path(), name, "quick", 1), Contains(expected));
    CHECK_THROWS_WITH(project.read(), Contains(expected));
    CHECK(airlight::read_bytes((project.path() / "precious/file").string()) == "mine");
  }
}

TEST_CASE("a sequence that is not listed, or badly, is one line", "[driver][flow]") {
  Frames project;
  project.write("experiments/sequences.toml", "[puf]\nproblem = \"flows/puff.toml\"\n");
  CHECK_THROWS_WITH(project.read(),
                    Contains("e.toml:4:1") && Contains("there is no sequence 'puff'") && Contains("puf"));
  project.list("n = 8, m = 3");
  CHECK_THROWS_WITH(make_sequence(project.path(), "puff", "quick", 1), Contains("puff") && Contains("'m'"));
  project.list("n = 8");
  CHECK_THAT(sequence_files(project.path(), "puff.csv", "quick", "here"), Contains("puff.quick/puff.####.csv"));
  // Wherever the project is named from: scenes look for what is relative beside themselves.
  CHECK(fs::path(sequence_files(fs::relative(project.path()), "puff.csv", "quick", "here")).is_absolute());
  CHECK_THROWS_WITH(sequence_files(project.path(), "puff.red.csv", "quick", "here"),
                    Contains("here: the sequence 'puff' has no files .red.csv, expected one of .vdb, .csv"));
  project.write("experiments/sequences.toml", "puff = 3\n");
  CHECK_THROWS_WITH(project.read(), Contains("expected a table [puff]"));
}

}  // namespace sequences_test
