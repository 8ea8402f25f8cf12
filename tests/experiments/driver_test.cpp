// Experiments through the driver: what is written, kept, computed anew and refused.
#include <catch2/catch.hpp>

#include "experiments/application/json_value.h"
#include "experiments/driver/run.h"
#include "scene/base/content_key.h"
#include "tests/experiments/small_project.h"

namespace driver_test {

using namespace airlight::experiments;
using namespace airlight::test;
using airlight::read_bytes;
namespace fs = std::filesystem;

namespace {

const std::string experiment_file = R"(title = "Steps"
layer = "airlight"
metrics = ["rel_l2", "bias"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "deterministic"
[[method]]
name = "marcher"
renderer = "ray_marcher"
settings = { kernel = "scalar" }
sweep = { key = "steps", values = [4, 64] }
[[method]]
renderer = "fogshop"
[profile.quick]
runs = 2
[[plot]]
x = "setting"
y = "rel_l2"
[[gate]]
method = "marcher"
setting = 64
metric = "rel_l2"
at_most = 0.01
[[gate]]
method = "marcher"
setting = 4
metric = "rel_l2"
at_most = 1e-9
[[expected]]
what = "frames per second"
paper = "120 at 800x600"
scene = "one"
method = "marcher"
setting = 64
metric = "seconds"
)";

struct Project : SmallProject {
  Project() : SmallProject(box_of_fog(16, 12, "vertical_fov = 0.7\n"), experiment_file) {}
  Outcome run(bool resume) const {
    return run_experiment(read_experiment(path(), "g/e", "quick"), {path(), resume, 1, false});
  }
  fs::path journal() const { return path() / "results/cache/rows/g/e.quick.jsonl"; }
};

double metric(const Row& row, const std::string& name) { return quantity(row, name).value().value; }

}  // namespace

TEST_CASE("an experiment says what each picture lacks, where it is asked", "[driver]") {
  const SmallProject project(box_of_fog(8, 6), "left_out = true\n" + experiment_file);
  const Outcome outcome =
      run_experiment(read_experiment(project.path(), "g/e", "quick"), {project.path(), false, 1, false});
  REQUIRE(outcome.rows.size() == 3);
  CHECK(outcome.rows[0].left_out == "orders of scattering above one");
  CHECK(outcome.rows[2].left_out.empty());  // it was refused
  const std::string table = read_bytes((project.path() / "results/g/e/table.csv").string());
  CHECK_THAT(table, Catch::Contains(",left_out,note\n") && Catch::Contains(",orders of scattering above one,"));
  CHECK_THAT(read_bytes((project.path() / "results/g/e/table.md").string()), Catch::Contains("| leaves out |"));
}

TEST_CASE("an experiment leaves its table, plots, pictures and record", "[driver]") {
  const Project project;
  const Outcome outcome = project.run(false);
  REQUIRE(outcome.rows.size() == 3);
  CHECK(outcome.complete);
  // The marcher's error is of second order or better in the step: sixteen times as many steps, at least 50 times less
  // (not 256: the reference is stored in single precision).
  CHECK(metric(outcome.rows[1], "rel_l2") < metric(outcome.rows[0], "rel_l2") / 50);
  CHECK(outcome.rows[0].runs == 2);
  CHECK_THAT(outcome.rows[2].note, Catch::StartsWith("not supported: "));
  CHECK(outcome.gates.at(0).passed);
  CHECK_FALSE(outcome.gates.at(1).passed);

  const fs::path results = project.path() / "results/g/e";
  const auto record = nlohmann::json::parse(read_bytes((results / "run.json").string()));
  for (const auto& table : record["tables"]) CHECK(fs::exists(results / table["file"].get<std::string>()));
  for (const auto& plot : record["plots"]) CHECK(fs::exists(results / plot["file"].get<std::string>()));
  REQUIRE(record["pictures"].size() == 1);
  REQUIRE(record["pictures"][0]["pictures"].size() == 2);  // reference and the last setting of the marcher
  for (const auto& picture : record["pictures"][0]["pictures"])
    CHECK(fs::exists(results / picture["file"].get<std::string>()));
  CHECK(record["profile"] == "quick");
  CHECK(record["complete"] == true);
  CHECK(record["gates"].size() == 2);
  CHECK_THAT(read_bytes((results / "table.md").string()),
             Catch::Contains("| marcher | 64 |") && Catch::Contains("FAILED"));
  CHECK_THAT(read_bytes((results / "expected.csv").string()), Catch::Contains(" at 16x12, "));
  CHECK_THAT(read_bytes((results / "table.csv").string()), Catch::StartsWith("scene,parameter,method,setting") &&
                                                               Catch::Contains(",layer,film,profile,rel_l2,") &&
                                                               Catch::Contains(",16x12,quick,"));
}

TEST_CASE("a run that was killed goes on where it was", "[driver]") {
  const Project project;
  const Outcome whole = project.run(false);
  const std::string journal = read_bytes(project.journal().string());
  // First the row that is not supported, then those that were timed in turns. Torn in the middle of the third.
  const std::size_t torn = journal.find("\n\n", journal.find("\n\n") + 1);
  std::ofstream(project.journal(), std::ios::trunc) << journal.substr(0, torn + 300);
  const Outcome resumed = project.run(true);
  REQUIRE(resumed.rows.size() == 3);
  CHECK(resumed.rows[0].seconds.value == whole.rows[0].seconds.value);  // kept
  CHECK(metric(resumed.rows[1], "rel_l2") == metric(whole.rows[1], "rel_l2"));
  CHECK(resumed.references.at(0).cached);
  // A whole line of another version of the program, which knew no `note`, is passed over.
  std::string old = journal.substr(1, journal.find('\n', 1) - 1);
  old.erase(0, 33);
  old.replace(old.find("\"note\""), 6, "\"noet\"");
  std::ofstream(project.journal(), std::ios::app) << airlight::content_key(std::string_view(old)) << ' ' << old << '\n';
  // Complete now: a third run keeps the times of the second.
  const Outcome third = project.run(true);
  CHECK(third.rows[1].seconds.value == resumed.rows[1].seconds.value);
  // Without resume everything is measured anew; the reference is still served.
  const Outcome anew = project.run(false);
  CHECK(anew.references.at(0).cached);
  CHECK(anew.rows[1].seconds.value != third.rows[1].seconds.value);
}

// Two results folders share the references alone: neither run takes rows, pictures or progress from the other.
TEST_CASE("a results folder of its own has its own tables, pictures and finished rows", "[driver]") {
  const Project project;
  const Outcome first = project.run(false);
  const std::string table = read_bytes((project.path() / "results/g/e/table.csv").string()),
                    journal = read_bytes(project.journal().string());
  const Folders mine(project.path(), project.path() / "mine");
  const auto run = [&](bool resume) {
    return run_experiment(read_experiment(mine, "g/e", "quick"), {mine, resume, 1, false});
  };
  const Outcome second = run(true);  // resumes nothing: the finished rows are those of another folder
  CHECK(second.references.at(0).cached);
  CHECK(second.rows[1].seconds.value != first.rows[1].seconds.value);
  CHECK(metric(second.rows[1], "rel_l2") == metric(first.rows[1], "rel_l2"));
  for (const char* file :
       {"g/e/table.csv", "g/e/run.json", "images/g/e/one/reference.exr", "images/g/e/one/marcher_64.exr"})
    CHECK(fs::exists(mine.results / file));
  CHECK_FALSE(fs::exists(mine.results / "cache"));
  CHECK(read_bytes((project.path() / "results/g/e/table.csv").string()) == table);
  CHECK(read_bytes(project.journal().string()) == journal);
  // A row whose picture was deleted is made again, the others are kept.
  const fs::path picture = mine.results / "images/g/e/one/marcher_64.exr";
  fs::remove(picture);
  const Outcome third = run(true);
  CHECK(fs::exists(picture));
  CHECK(third.rows[0].seconds.value == second.rows[0].seconds.value);
  CHECK(third.rows[1].seconds.value != second.rows[1].seconds.value);
  // The default folder by another name is the default folder.
  CHECK(Folders(project.path(), project.path() / "experiments/../results").default_results());
  CHECK_FALSE(mine.default_results());
}

TEST_CASE("profiles have folders, pictures and journals of their own", "[driver]") {
  const Project project;
  project.run(false);
  const fs::path results = project.path() / "results";
  const std::string quick = read_bytes((results / "g/e/run.json").string());
  Experiment paper = read_experiment(project.path(), "g/e", "paper");
  paper.timing = {1, 0, 0, 0};  // its own would warm up for seconds
  const Outcome outcome = run_experiment(paper, {project.path(), false, 1, false});
  CHECK(read_bytes((results / "g/e/run.json").string()) == quick);
  CHECK(fs::exists(results / "images/g/e/one/reference.exr"));  // kept: that of the other profile
  CHECK(fs::exists(results / "cache/rows/g/e.quick.jsonl"));
  CHECK(fs::exists(results / "cache/rows/g/e.paper.jsonl"));
  const auto record = nlohmann::json::parse(read_bytes((results / "g/e.paper/run.json").string()));
  CHECK(record["experiment"] == "g/e");
  CHECK(record["profile"] == "paper");
  CHECK_THAT(outcome.rows.at(0).image, Catch::StartsWith("g/e.paper/"));
  for (const auto& picture : record["pictures"][0]["pictures"])
    CHECK(fs::exists(results / "g/e.paper" / picture["file"].get<std::string>()));
}

TEST_CASE("a damaged cached reference is computed anew", "[driver]") {
  const Project project;
  const Outcome first = project.run(false);
  const fs::path image = project.path() / "results/cache/references" / (first.references.at(0).key + ".exr");
  std::string bytes = read_bytes(image.string());
  bytes[bytes.size() - 10] ^= 1;
  std::ofstream(image, std::ios::binary | std::ios::trunc) << bytes;
  const Outcome second = project.run(false);
  CHECK_FALSE(second.references.at(0).cached);
  CHECK(metric(second.rows[0], "rel_l2") == metric(first.rows[0], "rel_l2"));
}

namespace {

// Every file below a folder with its bytes.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& file : fs::recursive_directory_iterator(folder))
    if (file.is_regular_file()) files[file.path().string()] = read_bytes(file.path().string());
  return files;
}

std::string with(const std::string& insertion, const std::string& before) {
  std::string text = experiment_file;
  return text.insert(text.find(before), insertion);
}

}  // namespace

// The fault lies in the last scene, method or layer: nothing of the first may have been computed when it is found.
TEST_CASE("an experiment that is refused writes nothing, and removes nothing", "[driver]") {
  const Project project;
  const std::string scene = "[[scene]]\nname = \"two\"\nfile = \"scenes/", before = "[reference]";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {with(scene + "missing.toml\"\n", before), "missing.toml"},
      {with(scene + "one.toml\"\noverrides = { \"film.widht\" = 4 }\n", before), "nearest: width"},
      {with(scene + "one.toml\"\noverrides = { \"light.0.intensity\" = -1 }\n", before), "intensity"},
      {with("[[method]]\nname = \"odd\"\nrenderer = \"ray_marcher\"\nlayer = \"airlihgt\"\n", "[profile.quick]"),
       "no layer 'airlihgt'"},
      {std::string(experiment_file).replace(experiment_file.find("layer = \"airlight\""), 18, "layer = \"airlihgt\""),
       "no layer 'airlihgt'"},
      // The samples of `airlight` are not kept by batches: against a path tracer it cannot be judged.
      {std::string(experiment_file).replace(experiment_file.find("\"deterministic\""), 15, "\"path_tracer\""),
       "batches"},
  };
  for (const bool before_any : {true, false}) {
    if (!before_any) {
      project.write("experiments/g/e.toml", experiment_file);
      project.run(false);
    }
    for (const auto& [text, says] : bad) {
      project.write("experiments/g/e.toml", text);
      const auto was = contents(project.path());
      for (const bool resume : {false, true}) {
        CAPTURE(text, resume);
        CHECK_THROWS_WITH(project.run(resume), Catch::StartsWith("g/e: ") && Catch::Contains(says));
        CHECK(contents(project.path()) == was);
      }
    }
    CHECK(fs::exists(project.path() / "results") == !before_any);
  }
}

TEST_CASE("a parameter that was edited is that of the kept rows", "[driver]") {
  const Project project;
  const auto parameter = [&](const std::string& value) {
    project.write("experiments/g/e.toml", with("parameter = " + value + "\n", "[reference]"));
    return project.run(true).rows.at(0);
  };
  const Row first = parameter("3"), second = parameter("5");
  CHECK(second.parameter == 5);
  CHECK(second.seconds.value == first.seconds.value);  // it was kept
}

}  // namespace driver_test
