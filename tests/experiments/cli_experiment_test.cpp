// Experiments through the program: what is refused, what fails, what must not depend on what was computed before.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scene/film/film.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace cli_experiment_test {

using namespace airlight::test;
using airlight::read_bytes;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

std::string steps_experiment(const std::string& at_most, const std::string& at_top = "") {
  return against_quadrature({{"marcher", "ray_marcher", at_most, "steps = 64, kernel = \"scalar\""}}, at_top);
}

struct Project : SmallProject {
  Project() : SmallProject(box_of_fog(16, 8)) {}
};

// The columns up to the errors, without the times.
std::string errors(const Project& project, const std::string& name) {
  std::istringstream lines(read_bytes(project.file("results/" + name + "/table.csv")));
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 13 && std::getline(cells, cell, ','); ++i) out += cell + ",";
    out += "\n";
  }
  return out;
}

}  // namespace

TEST_CASE("experiment run exits 1 and names the gates that fail", "[cli]") {
  const Project project;
  project.write("experiments/g/bad.toml", steps_experiment("1e-12"));
  project.write("experiments/g/good.toml", steps_experiment("0.5"));
  const Result good = run("experiment run g/good --root .", project);
  CHECK(good.code == 0);
  CHECK(good.err.empty());
  const Result both = run("experiment run --root .", project);
  CHECK(both.code == 1);
  CHECK(both.err == "airlight: gate failed: g/bad: one, marcher: rel_l2\n");
  CHECK_THAT(both.out, Contains("0 of 1 gates ok: results/g/bad/table.md"));
  CHECK_THAT(both.out, Catch::StartsWith("[1 of 2] g/bad (quick): ") && Contains("\n[2 of 2] g/good (quick): ") &&
                           Contains(" left\n"));
  CHECK(run("experiment run --root . --resume", project).code == 1);  // kept rows are judged, too
}

// Last of all, after the gates.
TEST_CASE("experiment run ends with the summaries", "[cli]") {
  const Project project;
  const std::string expected =
      "[[expected]]\nwhat = \"w\"\npaper = \"p\"\nscene = \"one\"\nmethod = \"marcher\"\nmetric = \"bias\"\n";
  const auto text = [&](const std::string& summary) {
    std::string e = steps_experiment("0.5", summary);
    e.replace(e.find("[\"rel_l2\"]"), 10, "[\"rel_l2\", \"bias\"]");
    return e + expected;
  };
  project.write("experiments/g/a.toml", text("summary = \"The marcher is off by {1}.\"\n"));
  project.write("experiments/g/b.toml", text(""));
  const Result both = run("experiment run --root .", project);
  CAPTURE(both.out, both.err);
  CHECK(both.code == 0);
  const std::size_t last = both.out.rfind('\n', both.out.size() - 2) + 1;
  CHECK_THAT(both.out.substr(last), Catch::Matches("The marcher is off by -?[0-9.e-]+ %[.]\n"));
}

TEST_CASE("only experiments that say so are judged in tests", "[cli]") {
  const Project project;
  project.write("experiments/g/bad.toml", steps_experiment("1e-12", "in_tests = true\n"));
  project.write("experiments/g/slow.toml", steps_experiment("1e-12"));
  const Result in_tests = run("gates --root . --in-tests", project);
  CHECK(in_tests.code == 1);
  CHECK_THAT(in_tests.out, Contains("g/bad: one") && !Contains("g/slow"));
  CHECK_THAT(run("gates --root .", project).out, Contains("g/slow: one") && Contains("0 of 2 gates ok"));
}

TEST_CASE("tables and caches go where the options say, and nowhere else", "[cli]") {
  const Project project;
  project.write("experiments/g/good.toml", steps_experiment("0.5"));
  const Result run_there = run("experiment run --root . --results there --cache kept", project);
  CAPTURE(run_there.err);
  CHECK(run_there.code == 0);
  CHECK_THAT(run_there.out, Contains("1 of 1 gates ok: there/g/good/table.md"));
  CHECK(run("gates --root . --results gates --cache kept", project).code == 0);
  for (const char* file :
       {"there/g/good/run.json", "there/images/g/good/one/reference.exr", "gates/g/good/run.json", "kept/references"})
    CHECK(project.has(file));
  CHECK_FALSE(project.has("results"));
}

TEST_CASE("a run into another folder says whether it agrees with the committed tables", "[cli]") {
  const Project project;
  project.write("experiments/g/e.toml", steps_experiment("0.5"));
  project.write("experiments/g/new.toml", steps_experiment("0.5"));
  REQUIRE(run("experiment run g/e --root .", project).code == 0);
  const auto there = [&] { return run("experiment run --root . --results there", project).out; };
  const std::string agrees = there();
  CHECK_THAT(agrees, Contains("\n  agrees with results/g/e: 2 of 2 figures; times ") &&
                         Contains("\n  there is no committed table to compare with\n") &&
                         Catch::EndsWith(
                             "\n1 of 1 experiments agree with the committed tables; 1 without a committed table\n"));
  std::string record = read_bytes(project.file("results/g/e/run.json"));
  const std::size_t at = record.find("\"value\": ") + 9;
  record.replace(at, record.find_first_of(",\n", at) - at, "0.75");
  for (const char* end : {"low", "high"}) {
    const std::size_t from = record.find("\"" + std::string(end) + "\": ") + std::string(end).size() + 4;
    record.replace(from, record.find_first_of(",\n", from) - from, "0.75");
  }
  project.write("results/g/e/run.json", record);
  CHECK_THAT(there(), Contains("\n  DIFFERS from results/g/e: rel_l2 of one, marcher: ") &&
                          Contains(", committed 0.75 (1 of 2 figures)") &&
                          Contains("\n0 of 1 experiments agree with the committed tables; differs: g/e; 1 without"));
}

// Found above the program, a project is not the one that the current folder belongs to.
TEST_CASE("a project that is not above the current folder is named", "[cli]") {
  const airlight::TemporaryFolder elsewhere;
  const Result list = run("experiment list fogshop/table1", elsewhere);
  CAPTURE(list.out);
  CHECK(list.code == 0);
  CHECK(list.error_lines() == 1);
  CHECK_THAT(list.err, Catch::StartsWith("airlight: no project above the current folder") &&
                           Contains(fs::canonical(root).string()) && Contains("above the program"));
  const Project project;
  project.write("experiments/g/good.toml", steps_experiment("0.5"));
  for (const std::string start : {"", "cd experiments/g && "}) {
    const Result here = run_command(start + "'" + program + "' experiment list", project);
    CHECK(here.err.empty());
    CHECK_THAT(here.out, Catch::StartsWith("g/good "));
  }
}

// A folder that cannot be written to says nothing about accuracy. The second cannot be made even by root.
TEST_CASE("what cannot be written is an error of one line, not a failed gate", "[cli]") {
  const Project project;
  project.write("experiments/g/good.toml", steps_experiment("0.5"));
  project.write("file", "");
  for (const char* command : {"gates --root . --junit report.xml", "experiment run --root ."})
    for (const char* folder : {"--results file", "--results file/below", "--results /proc/none", "--cache file"}) {
      const Result refused = run(std::string(command) + " " + folder, project);
      CAPTURE(command, folder, refused.out, refused.err);
      CHECK(refused.code == 2);
      CHECK(refused.error_lines() == 1);
      CHECK_THAT(refused.err,
                 Catch::StartsWith("airlight: ") && Contains(std::string(folder).substr(folder[2] == 'r' ? 10 : 8)));
      CHECK_THAT(refused.out, !Contains("FAILED") && !Contains("gates ok"));
      if (command[0] == 'g')
        CHECK_THAT(read_bytes(project.file("report.xml")),
                   Contains("tests=\"1\" failures=\"0\" skipped=\"0\" errors=\"1\"") &&
                       Contains("><error message=\"") && !Contains("<failure"));
    }
}

// Gates and runs that find all their rows leave the record of the run that made them, with its date and duration.
TEST_CASE("a record tells of the run that made its rows", "[cli]") {
  const Project project;
  project.write("experiments/g/good.toml", steps_experiment("0.5"));
  REQUIRE(run("experiment run --root .", project).code == 0);
  const auto record = [&] { return read_bytes(project.file("results/g/good/run.json")); };
  const std::string first = record();
  CHECK(run("gates --root .", project).code == 0);
  CHECK(run("experiment run --root . --resume", project).code == 0);
  CHECK(record() == first);
  // A gate that is moved is another table.
  project.write("experiments/g/good.toml", steps_experiment("0.4"));
  CHECK(run("gates --root .", project).code == 0);
  CHECK(record() != first);
}

// The second experiment's second scene is wrong: the first experiment is not begun.
TEST_CASE("all experiments are checked before the first is computed", "[cli]") {
  const Project project;
  project.write("experiments/g/a.toml", steps_experiment("0.5"));
  std::string text = steps_experiment("0.5");
  text.insert(text.find("[reference]"),
              "[[scene]]\nname = \"two\"\nfile = \"scenes/one.toml\"\noverrides = { \"film.widht\" = 4 }\n");
  project.write("experiments/g/b.toml", text);
  for (const char* command : {"experiment run --root .", "experiment run --root . --resume", "gates --root ."}) {
    const Result refused = run(command, project);
    CAPTURE(command, refused.err);
    CHECK(refused.code == 2);
    CHECK(refused.out.empty());
    CHECK(refused.error_lines() == 1);
    CHECK_THAT(refused.err, Catch::StartsWith("airlight: g/b: ") && Contains("nearest: width"));
    CHECK_FALSE(project.has("results"));
  }
  REQUIRE(run("experiment run g/a --root .", project).code == 0);
  const std::string table = read_bytes(project.file("results/g/a/table.csv"));
  const auto reference = fs::last_write_time(project.path() / "results/images/g/a/one/reference.exr");
  CHECK(run("experiment run --root .", project).code == 2);
  CHECK(read_bytes(project.file("results/g/a/table.csv")) == table);
  CHECK(fs::last_write_time(project.path() / "results/images/g/a/one/reference.exr") == reference);
}

// Sample counts up and down, in one folder whose caches fill, and each in a folder of its own: the same bytes.
TEST_CASE("pictures and tables do not depend on what the caches hold", "[cli]") {
  const Project filling;
  for (const int samples : {256, 64, 192, 1024, 64, 80, 256}) {
    CAPTURE(samples);
    const Project fresh;
    const std::string text = R"(title = "Noise"
metrics = ["rel_l2"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "path_tracer"
settings = { samples = )" + std::to_string(samples) +
                             R"( }
[[method]]
renderer = "ray_marcher"
settings = { kernel = "scalar" }
[profile.quick]
budget = 0
)";
    const std::string picture = "render experiments/scenes/one.toml -m path_tracer --cache kept --samples " +
                                std::to_string(samples) + " --png a.png -o a.exr";
    for (const Project* project : {&filling, &fresh}) {
      project->write("experiments/g/e.toml", text);
      REQUIRE(run("experiment run --root .", *project).code == 0);
      REQUIRE(run(picture, *project).code == 0);
    }
    const auto kept = airlight::scene::read_exr(filling.file("a.exr")),
               made = airlight::scene::read_exr(fresh.file("a.exr"));
    CHECK(kept.layers == made.layers);
    CHECK(kept.metadata.at("samples") == std::to_string(samples));
    CHECK(read_bytes(filling.file("a.png")) == read_bytes(fresh.file("a.png")));
    CHECK(airlight::scene::read_exr(filling.file("results/images/g/e/one/reference.exr")).layers ==
          airlight::scene::read_exr(fresh.file("results/images/g/e/one/reference.exr")).layers);
    CHECK(errors(filling, "g/e") == errors(fresh, "g/e"));
    CHECK_THAT(errors(filling, "g/e"), Contains(",mean,"));
    REQUIRE(run("experiment run --root .", filling).code == 0);  // once more, with everything there
    CHECK(errors(filling, "g/e") == errors(fresh, "g/e"));
  }
}

// The shader that writes the airlight, made half as bright again: a relative error of 0.5.
TEST_CASE("gates see a shader that was changed by hand", "[cli][skips]") {
  const Project project;
  project.write("experiments/g/e.toml", against_quadrature({{"marcher", "ray_marcher_gpu", "1e-3", "steps = 64"}}));
  const Result first = run("gates --root .", project);
  CAPTURE(first.out, first.err);
  if (first.out.find("skipped") != std::string::npos) {
    WARN("test skipped: no device");
    return;
  }
  CHECK(first.code == 0);
  fs::copy(root + "/gpu", project.path() / "gpu", fs::copy_options::recursive);
  setenv("AIRLIGHT_SHADERS", (project.path() / "gpu").c_str(), 1);
  const std::string journal = project.file("results/cache/rows/g/e.quick.jsonl");
  const std::string rows = read_bytes(journal);
  CHECK(run("gates --root .", project).out == first.out);
  CHECK(read_bytes(journal) == rows);  // a copy of the shaders makes the same rows
  std::string shader = read_bytes(project.file("gpu/ray_marcher/march.comp"));
  const std::string line = "Pixel(pixel.airlight + airlight,";
  REQUIRE(shader.find(line) != std::string::npos);
  shader.replace(shader.find(line), line.size(), "Pixel(pixel.airlight + 1.5 * airlight,");
  project.write("gpu/ray_marcher/march.comp", shader);
  const Result changed = run("gates --root .", project);
  unsetenv("AIRLIGHT_SHADERS");
  CAPTURE(changed.out);
  CHECK(changed.code == 1);
  CHECK_THAT(changed.out, Contains("rel_l2 <= 0.001 fails: 0.5"));
  CHECK(changed.err == "airlight: gate failed: g/e: one, marcher: rel_l2\n");
  CHECK(run("gates --root .", project).out == first.out);
}

}  // namespace cli_experiment_test
