// table.md and the CSV files beside it: their order, and that they can be written again from the record of a run.
#include "experiments/driver/tables.h"

#include <catch2/catch.hpp>

#include "experiments/driver/plots.h"
#include "experiments/driver/run.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace tables_test {

using namespace airlight::experiments;
using namespace airlight::test;
using airlight::read_bytes;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string experiment_file = R"(title = "Steps"
paper = "A paper, Figure 1"
about = "Words about it."
layer = "airlight"
metrics = ["rel_l2"]
stages = true
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "deterministic"
[[method]]
name = "marcher"
renderer = "ray_marcher"
settings = { kernel = "scalar" }
sweep = { key = "steps", values = [4, 16, 64] }
[[method]]
name = "again"
renderer = "ray_marcher"
settings = { kernel = "scalar" }
sweep = { key = "steps", values = [4, 16, 64] }
[[method]]
renderer = "fogshop"
[profile.quick]
runs = 7
[[plot]]
x = "setting"
y = "rel_l2"
[[gate]]
method = "marcher"
metric = "rel_l2"
at_most = 0.5
[[speed_up]]
baseline = "marcher"
method = "again"
metric = "rel_l2"
[[expected]]
what = "speed-up, at equal error"
paper = "none"
scene = "one"
baseline = "marcher"
method = "again"
metric = "rel_l2"
[conclusion]
text = "More steps are closer."
holds = "[one|marcher|64] < [one|marcher|4]"
[[claim]]
where = "Figure 1"
claim = "the same"
verdict = "not comparable: no number"
[[claim]]
where = "Figure 2"
claim = "slow"
verdict = "reproduced"
holds = "[one|marcher|64|seconds] > 0"
table = "g/e.paper/stages.csv"
)";

struct Project : SmallProject {
  Project() : SmallProject(box_of_fog(16, 12), experiment_file) {
    run_experiment(read_experiment(path(), "g/e", "quick"), {path(), false, 1, false});
  }
  fs::path folder() const { return path() / "results/g/e"; }
  std::string page() const { return read_bytes((folder() / "table.md").string()); }
  std::map<std::string, std::string> recorded() const {
    return recorded_tables(read_experiment(path(), "g/e", "quick"), folder());
  }
};

}  // namespace

TEST_CASE("the page of an experiment says first what the table shows, then has plots, rows and the rest", "[driver]") {
  const Project project;
  const std::string page = project.page();
  std::size_t at = 0;
  for (const std::string line :
       {"# Steps\n\nMore steps are closer.\n\n",
        "- Claim (Figure 1): the same. Verdict: **not comparable: no number**.\n",
        "- Claim (Figure 2): slow. Verdict (checked on the table `g/e.paper`): **reproduced**.\n\n",
        "3 of 3 gates hold.", has_gnuplot() ? "\n\n![relative L2 error against" : "", has_gnuplot() ? "](plots/" : "",
        "\n\n| scene | method | setting | film | profile | rel_l2 |", "\n| one | marcher | 4 | 16x12 | quick | ",
        "\n\n## Stages\n\n", "\n\n## Printed and measured\n\n", "\n\n## Equal error, equal time\n\n",
        "\n\n## About\n\n- Experiment: `experiments/g/e.toml`.\n- Scenes: `experiments/scenes/one.toml`.\n",
        "- Run it again: `airlight experiment run g/e --results DIR`.\n\n",
        "A paper, Figure 1.\n\nWords about it.\n\n## Gates\n\n- ok: ", "\n\n## Conditions\n\n",
        "- Reference of one: "}) {
    CAPTURE(page, line);
    const std::size_t found = page.find(line, at);
    REQUIRE(found != std::string::npos);
    at = found + 1;
  }
}

TEST_CASE("tables are written again from the record of a run, byte for byte", "[driver]") {
  const Project project;
  const auto files = project.recorded();
  CHECK(files.size() == 6);
  for (const auto& [name, text] : files) {
    INFO(name);
    CHECK(text == read_bytes((project.folder() / name).string()));
  }
  // A changed verdict is shown, and the record stays.
  const std::string record = read_bytes((project.folder() / "run.json").string());
  std::string changed = experiment_file;
  changed.replace(changed.find("no number"), 9, "a picture");
  project.write("experiments/g/e.toml", changed);
  const Result again = run("experiment tables g/e --root .", project);
  CHECK(again.code == 0);
  CHECK(again.out == "results/g/e/table.md\n");
  CHECK_THAT(project.page(), Contains("Verdict: **not comparable: a picture**"));
  CHECK(read_bytes((project.folder() / "run.json").string()) == record);
  // No record, and one of another program.
  CHECK(run("experiment tables --profile paper --root .", project).code == 2);
  project.write("results/g/e/run.json", "{\"rows\": []}");
  const Result foreign = run("experiment tables --root .", project);
  CHECK(foreign.code == 2);
  CHECK_THAT(foreign.err, Contains("run.json: not a record of this version") && !Contains("\n "));
}

// What `airlight experiment tables` would write, with --profile quick and paper. Studies that are finished have no experiment file.
TEST_CASE("committed tables are those of their records and experiment files", "[committed_tables]") {
  std::size_t compared = 0;
  for (const std::string& id : experiment_ids("."))
    for (const std::string profile : {"quick", "paper"}) {
      const fs::path folder = fs::path("results") / results_name(id, profile);
      if (!fs::exists(folder / "run.json")) continue;
      for (const auto& [name, text] : recorded_tables(read_experiment(fs::path("."), id, profile), folder)) {
        INFO((folder / name).string() << ": airlight experiment tables " << id << " --profile " << profile);
        CHECK((text == read_bytes((folder / name).string())));
      }
      ++compared;
    }
  CHECK(compared > 190);
}

}  // namespace tables_test
