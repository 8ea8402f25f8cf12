// Experiments of kind "numbers": what probes find goes through tables, gates, plots, records and resuming like pictures.
#include <catch2/catch.hpp>
#include <set>

#include "experiments/application/json_value.h"
#include "experiments/application/probes.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/run.h"
#include "experiments/verify/check.h"
#include "tests/experiments/run_program.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace numbers_test {

using namespace airlight::experiments;
using airlight::read_bytes;
using airlight::TemporaryFolder;
using airlight::test::replaced;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string file = R"(kind = "numbers"
title = "Numbers"
metrics = ["median_error", "p99_error"]
[[method]]
name = "near"
probe = "evaluator_angles"
settings = { reach = 0.25, cases = 200 }
sweep = { key = "degree", values = [2, 8] }
[[method]]
name = "time"
probe = "evaluator_times"
settings = { cases = 100, runs = 3 }
[[plot]]
x = "setting"
y = "median_error"
[[gate]]
method = "near"
setting = 8
metric = "median_error"
at_most = 1e-9
[[gate]]
method = "near"
setting = 2
metric = "median_error"
at_most = 1e-9
[[expected]]
what = "error"
paper = "small"
method = "near"
setting = 8
metric = "p99_error"
)";

struct Project : TemporaryFolder {
  explicit Project(const std::string& text) { write("experiments/g/e.toml", text); }
  Outcome run(bool resume) const {
    return run_experiment(read_experiment(path(), "g/e", "quick"), {path(), resume, 1, false});
  }
  std::string result(const char* name) const { return read_bytes((path() / "results/g/e" / name).string()); }
};

double figure(const Row& row, const std::string& name) { return quantity(row, name).value().value; }

}  // namespace

TEST_CASE("numbers have tables, gates, plots, records and rows that are kept", "[driver]") {
  const Project project(file);
  const Outcome outcome = project.run(false);
  REQUIRE(outcome.rows.size() == 3);
  CHECK(figure(outcome.rows[1], "median_error") < figure(outcome.rows[0], "median_error") / 1e3);
  CHECK(outcome.gates.at(0).passed);
  CHECK_FALSE(outcome.gates.at(1).passed);
  CHECK(outcome.gates.at(1).name == "g/e: near 2: median_error");
  CHECK(outcome.rows[0].runs == 0);
  CHECK(outcome.rows[2].runs == 3);  // its own timed runs
  CHECK(quantity(outcome.rows[2], "seconds").value().value < 1e-3);
  CHECK_THAT(project.result("table.md"), Contains("| near | 8 |") && !Contains("| scene |") && !Contains("| film |"));
  CHECK_THAT(project.result("table.csv"), Contains("near,8,evaluator_angles,") && !Contains(",film,"));
  const auto record = nlohmann::json::parse(project.result("run.json"));
  CHECK(record["rows"].size() == 3);
  for (const auto& plot : record["plots"]) CHECK(fs::exists(project.path() / "results/g/e" / plot["file"]));
  const Outcome kept = project.run(true);
  CHECK(quantity(kept.rows[2], "seconds").value().value == quantity(outcome.rows[2], "seconds").value().value);
  CHECK(nlohmann::json::parse(project.result("run.json")) == record);
}

TEST_CASE("a mistake in an experiment of numbers is one line", "[driver]") {
  const auto refused = [](const std::string& from, const std::string& to, const std::string& expected) {
    const Project project(replaced(file, from, to));
    CAPTURE(from, to);
    CHECK_THROWS_WITH(read_experiment(project.path(), "g/e", "quick"), Contains(expected));
  };
  refused("evaluator_angles", "evaluator_angels", "(nearest: evaluator_angles)");
  refused("[\"median_error\"", "[\"median_eror\"", "(nearest: median_error)");
  refused("reach = 0.25", "reech = 0.25", "(nearest: reach)");
  refused("probe = ", "renderer = ", "probe");
  refused("title =", "layer = \"mean\"\ntitle =", "layer");
  const Project missing(replaced(file, "[[method]]", "[[scene]]\nfile = \"nothing.json\"\n[[method]]"));
  CHECK_THROWS_WITH(missing.run(false), Contains("nothing.json"));
  CHECK_FALSE(fs::exists(missing.path() / "results"));
}

// Two rows with cells, one too dark everywhere beyond some extinction.
TEST_CASE("maps of numbers are drawn side by side", "[driver]") {
  const Project project(R"(kind = "numbers"
title = "Maps"
metrics = ["cells"]
[[plot]]
map = true
name = "stability"
[[method]]
probe = "evaluator_map"
settings = { per_decade = 1 }
sweep = { key = "precision", values = ["single", "double"] }
)");
  const Outcome outcome = project.run(false);
  CHECK(figure(outcome.rows[0], "cells") < figure(outcome.rows[1], "cells"));
  const std::string data = project.result("plots/stability.csv");
  CHECK(std::count(data.begin(), data.end(), '\n') == 1 + 2 * (1 + 11 * 10 + 2));
  CHECK_THAT(data, Contains("# , evaluator_map, double\n1e-06,1e-06,") && Contains("nan"));
  CHECK(fs::exists(project.path() / "results/g/e/plots/stability.svg"));
  // The rows that are kept have their maps.
  fs::remove_all(project.path() / "results/g");
  project.run(true);
  CHECK(project.result("plots/stability.csv") == data);
}

// A kind of vectors that is read and can be computed is a row of the experiment; one that compares nothing fails its
// gate.
TEST_CASE("the experiment of oracle vectors forgets no kind", "[driver]") {
  const Experiment e = read_experiment(fs::path(airlight::test::root), "reference/oracles", "quick");
  for (const SceneCase& c : e.scenes) {
    std::set<std::string> listed, there;
    for (const MethodCase& m : e.methods)
      if (is_on(m, c)) listed.insert(m.setting);
    const auto json = nlohmann::json::parse(read_bytes(c.file.string()));
    for (const auto& v : json["vectors"]) {
      const std::string kind = v["kind"];
      const verification::Value value(v, kind);
      const auto family = verification::family_of(verification::Value(json, c.name));
      if (verification::find_reader(family, kind)(value).job) there.insert(kind);
    }
    CAPTURE(c.name);
    CHECK(listed == there);
  }
  const TemporaryFolder folder;
  folder.write("vectors.json",
               R"({"paper": "compensated_ray_marching_2008", "vectors": [{"id": "a", "kind": "diffusion_slab_marshak",)"
               R"( "input": {"albedo": 0.9, "g": 0, "sigma_t": 1, "D": 1, "thickness": 10, "J0": 0.3, "J1": 0.1},)"
               R"( "expected": {}, "rtol": 0, "atol": 0}]})");
  folder.write("experiments/g/e.toml", R"(kind = "numbers"
title = "Nothing"
metrics = ["worst_share"]
[[scene]]
file = "../vectors.json"
[[method]]
probe = "oracle_vectors"
settings = { kind = "diffusion_slab_marshak" }
[[gate]]
metric = "worst_share"
at_most = 1
)");
  const Outcome outcome =
      run_experiment(read_experiment(folder.path(), "g/e", "quick"), {folder.path(), false, 1, false});
  REQUIRE(outcome.gates.size() == 1);
  CHECK_FALSE(outcome.gates[0].passed);
  CHECK_FALSE(outcome.gates[0].skipped);
}

}  // namespace numbers_test
