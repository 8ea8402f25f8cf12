#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "experiments/driver/content_key.h"
#include "experiments/driver/journal.h"
#include "experiments/driver/junit.h"
#include "experiments/driver/run.h"
#include "experiments/driver/tables.h"
#include "experiments/driver/timing.h"
#include "tests/temporary_folder.h"

using namespace airlight::experiments;
using airlight::read_bytes;
using airlight::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

const std::string scene_file = R"([film]
width = 16
height = 12
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vertical_fov = 0.7
[[light]]
type = "point"
position = [1.5, 2, 1]
intensity = 5
[[medium]]
type = "homogeneous"
sigma_t = 0.5
region = { type = "box", lo = [-1, -1, -1], hi = [1, 1, 1] }
)";

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

struct Project {
  TemporaryFolder folder;
  Project() {
    folder.write("experiments/README.md", "");
    folder.write("experiments/scenes/one.toml", scene_file);
    folder.write("experiments/g/e.toml", experiment_file);
  }
  Outcome run(bool resume) const {
    return run_experiment(read_experiment(folder.path(), "g/e", "quick"), {folder.path(), resume, 1, false});
  }
  fs::path journal() const { return folder.path() / "results/cache/rows/g/e.quick.jsonl"; }
};

double metric(const Row& row, const std::string& name) { return quantity(row, name).value().value; }

Row named_row(const std::string& scene, const std::string& method, double value, double low, double high) {
  Row row;
  row.scene = scene;
  row.method = method;
  row.runs = 1;
  row.measures = {{"rel_l2", value, low, high, 0.01, low <= 0}};
  return row;
}

}  // namespace

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

  const fs::path results = project.folder.path() / "results/g/e";
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
  CHECK_THAT(read_bytes((results / "table.csv").string()), Catch::StartsWith("scene,parameter,method,setting"));
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
  std::ofstream(project.journal(), std::ios::app) << content_key(std::string_view(old)) << ' ' << old << '\n';
  // Complete now: a third run keeps the times of the second.
  const Outcome third = project.run(true);
  CHECK(third.rows[1].seconds.value == resumed.rows[1].seconds.value);
  // Without resume everything is measured anew; the reference is still served.
  const Outcome anew = project.run(false);
  CHECK(anew.references.at(0).cached);
  CHECK(anew.rows[1].seconds.value != third.rows[1].seconds.value);
}

TEST_CASE("profiles have folders, pictures and journals of their own", "[driver]") {
  const Project project;
  project.run(false);
  const fs::path results = project.folder.path() / "results";
  const std::string quick = read_bytes((results / "g/e/run.json").string());
  Experiment paper = read_experiment(project.folder.path(), "g/e", "paper");
  paper.timing = {1, 0, 0, 0};  // its own would warm up for seconds
  const Outcome outcome = run_experiment(paper, {project.folder.path(), false, 1, false});
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
  const fs::path image = project.folder.path() / "results/cache/references" / (first.references.at(0).key + ".exr");
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

// What is wrong lies in the last scene, method or layer: nothing of the first may have been computed by then.
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
      project.folder.write("experiments/g/e.toml", experiment_file);
      project.run(false);
    }
    for (const auto& [text, says] : bad) {
      project.folder.write("experiments/g/e.toml", text);
      const auto was = contents(project.folder.path());
      for (const bool resume : {false, true}) {
        CAPTURE(text, resume);
        CHECK_THROWS_WITH(project.run(resume), Catch::StartsWith("g/e: ") && Catch::Contains(says));
        CHECK(contents(project.folder.path()) == was);
      }
    }
    CHECK(fs::exists(project.folder.path() / "results") == !before_any);
  }
}

TEST_CASE("a parameter that was edited is that of the kept rows", "[driver]") {
  const Project project;
  const auto parameter = [&](const std::string& value) {
    project.folder.write("experiments/g/e.toml", with("parameter = " + value + "\n", "[reference]"));
    return project.run(true).rows.at(0);
  };
  const Row first = parameter("3"), second = parameter("5");
  CHECK(second.parameter == 5);
  CHECK(second.seconds.value == first.seconds.value);  // it was kept
}

TEST_CASE("gates fail only beyond the interval", "[driver]") {
  Experiment e;
  e.id = "g/e";
  GateCase most;
  most.method = "m";
  most.metric = "rel_l2";
  most.at_most = 0.1;
  GateCase least = most;
  least.at_most = airlight::infinity;
  least.at_least = 0.5;
  const auto passed = [&](const GateCase& gate, const Row& row) {
    e.gates = {gate};
    const auto results = judge(e, {row});
    REQUIRE(results.size() == 1);
    return results[0].passed;
  };
  CHECK(passed(most, named_row("s", "m", 0.12, 0.09, 0.15)));
  CHECK_FALSE(passed(most, named_row("s", "m", 0.12, 0.11, 0.13)));
  CHECK(passed(most, named_row("s", "m", 0.12, 0, 0.3)));
  CHECK(passed(least, named_row("s", "m", 0.45, 0.4, 0.51)));
  CHECK_FALSE(passed(least, named_row("s", "m", 0.45, 0.4, 0.49)));
  CHECK_FALSE(passed(most, named_row("s", "other", 0, 0, 0)));  // no such row
  Row unsupported = named_row("s", "m", 0, 0, 0);
  unsupported.runs = 0;
  unsupported.measures.clear();
  CHECK_FALSE(passed(most, unsupported));
  CHECK_FALSE(passed(most, named_row("s", "m", std::nan(""), std::nan(""), std::nan(""))));
}

TEST_CASE("a bound by row stands for that of the gate, on the device where it was measured", "[driver]") {
  Experiment e;
  e.id = "g/e";
  GateCase law;
  law.metric = "rel_l2";
  law.at_most = 0.1;
  GateCase bound = law;
  bound.by_row = true;
  bound.scene = "s";
  bound.method = "m";
  bound.at_most = 0.02;
  const auto judged = [&](const std::vector<GateCase>& gates, const Row& row) {
    e.gates = gates;
    const auto results = judge(e, {row});
    REQUIRE(results.size() == 1);
    return std::string(word(results[0]));
  };
  Row row = named_row("s", "m", 0.03, 0.03, 0.03);
  CHECK(judged({law}, row) == "ok");
  CHECK(judged({bound, law}, row) == "FAILED");
  row.device = "another";
  CHECK(judged({bound, law}, row) == "ok");  // the gate's own bound
  law.at_most = airlight::infinity;
  CHECK(judged({bound, law}, row) == "skipped");  // there is none for this device
  row.device.clear();
  CHECK(judged({law}, row) == "FAILED");  // nothing bounds a figure that a gate covers
  // Names are exact: "s 2" is another scene, and a line whose row has gone fails.
  bound.scene = "gone";
  e.gates = {bound};
  CHECK_FALSE(judge(e, {named_row("gone 2", "m", 0, 0, 0)})[0].passed);
}

TEST_CASE("gates on what the machine lacks are skipped", "[driver]") {
  Experiment e;
  e.id = "g/e";
  GateCase gate;
  gate.method = "m";
  gate.metric = "rel_l2";
  gate.at_most = 0.1;
  e.gates = {gate};
  Row row = named_row("s", "m", 0, 0, 0);
  row.runs = 0;
  row.measures.clear();
  row.note = "not available on this machine: gpu";
  Row asked_for = row;  // by name
  row.unavailable = true;
  const auto results = judge(e, {row, named_row("t", "m", 0.01, 0, 0.02), asked_for});
  REQUIRE(results.size() == 3);
  CHECK(results[0].skipped);
  CHECK_THAT(results[0].text, Catch::Contains("is skipped: not available on this machine"));
  const GateCounts counts = count(results);
  CHECK(counts.skipped == 1);
  CHECK(counts.passed == 1);
  CHECK(counts.failed == 1);
  CHECK(std::string(word(results[2])) == "FAILED");
}

TEST_CASE("rows survive their record", "[driver]") {
  Row row = named_row("s, with \"quotes\"", "m", 0.1, 0.05, 0.2);
  row.parameter = 0.3;
  row.seconds = {1, 0.5, 2};
  row.counters = {{"rays", 12}};
  row.width = 100;
  row.height = 75;
  row.stages = {{"slices", 0.25}};
  row.times = {0.5, 1, 2};
  row.group = "together";
  row.waited = 0.25;
  row.device = "somewhere";
  row.measures.push_back({"p95", std::nan(""), std::nan(""), std::nan(""), 0, false});
  const Row back = row_from_json(nlohmann::json::parse(to_json(row).dump()));
  CHECK(to_json(back).dump() == to_json(row).dump());
  CHECK(std::isnan(back.measures[1].value));
  CHECK(csv_field(row.scene) == "\"s, with \"\"quotes\"\"\"");
}

TEST_CASE("timed runs follow the rule", "[driver]") {
  int count = 0;
  const Timing five = time_runs({5, 0, 2, 0}, 1e-6, [&] { ++count; });
  CHECK(five.runs == 5);
  CHECK(count == 5);
  CHECK(five.coverage == Approx(0.9375));
  const Timing none = time_runs({5, 0, 0.5, 0}, 0.6, [&] { FAIL("the budget is spent"); });
  CHECK(none.runs == 1);
  CHECK(none.seconds.value == 0.6);
  count = 0;
  const Timing least = time_runs({31, 0, 0.1, 0}, 0.12, [&] { ++count; });
  CHECK(least.runs == 7);  // of a short job, though the budget is spent
  CHECK(least.coverage > 0.95);
  CHECK(time_runs({31, 0, 0, 0}, 0.01, [&] { FAIL("there is no budget"); }).runs == 1);
  CHECK(time_runs({5, 0, 0.01, 0}, 0.01, [&] {}).runs == 5);
  count = 0;
  const Timing warmed = time_runs({31, 0.02, 60, 0}, 0, [&] { ++count; });
  CHECK(warmed.runs == 31);
  CHECK(count > 31);  // warm-up runs are not counted
}

// A machine whose speed halves while it is watched, by a clock of its own: run k of all takes 1 + k / 60 s for one
// piece of work. Sixty runs of two identical jobs: in turns (A B, B A, A B, ...) both have the median 1 + 29.5 / 60 to
// within one run; one after the other 1 + 14.5 / 60 and 1 + 44.5 / 60, a ratio of 1.40.
TEST_CASE("what slows the machine slows rows that are timed in turns alike", "[driver]") {
  double now = 0;
  int made = 0;
  std::string order;
  const auto job = [&](char name) {
    return TimedJob{0.9, [&, name] {
                      order += name;
                      now += 1 + made++ / 60.0;
                    }};
  };
  const TimingRule rule{30, 0, 1e6, 0};
  const auto timings = time_runs(rule, {job('a'), job('b')}, [&] { return now; });
  REQUIRE(timings.size() == 2);
  CHECK(order.substr(0, 6) == "abbaab");
  CHECK(timings[0].runs == 30);
  CHECK(timings[0].seconds.value == Approx(1 + 29.5 / 60).margin(0.51 / 60));
  CHECK(timings[0].seconds.value / timings[1].seconds.value == Approx(1).margin(0.01));
  CHECK(timings[0].times.size() == 30);
  now = made = 0;
  const auto alone = time_runs(rule, {job('a')}, [&] { return now; });
  const auto after = time_runs(rule, {job('b')}, [&] { return now; });
  CHECK(after[0].seconds.value / alone[0].seconds.value == Approx((1 + 44.5 / 60) / (1 + 14.5 / 60)));
}

TEST_CASE("timed in turns, each job has its own budget, and a short one its caches", "[driver]") {
  double now = 0;
  int slow = 0, quick = 0;
  const TimedJob of_two_seconds{2, [&] { now += 2, ++slow; }}, of_a_millisecond{1e-3, [&] { now += 1e-3, ++quick; }};
  const auto timings = time_runs({31, 0, 9, 0}, {of_two_seconds, of_a_millisecond}, [&] { return now; });
  // 2 s of the first render and three runs are 8 s: the next would pass 9 s.
  CHECK(timings[0].runs == 3);
  CHECK(slow == 3);
  CHECK(timings[1].runs == 31);
  CHECK(quick == 62);  // every other one untimed
  CHECK(timings[1].seconds.value == Approx(1e-3));
}

TEST_CASE("times of stages are medians of the warm runs", "[driver]") {
  StageTimes times;
  CHECK(times.medians().empty());
  times.add({{"a", 9}, {"b", 8}});
  CHECK(times.medians() == std::vector<std::pair<std::string, double>>{{"a", 9}, {"b", 8}});
  times.add({{"a", 1}, {"b", 2}});
  times.add({{"a", 3}, {"b", 7}});
  times.add({{"a", 2}});  // b was left out
  CHECK(times.medians() == std::vector<std::pair<std::string, double>>{{"a", 2}, {"b", 4.5}});
}

TEST_CASE("a JUnit report escapes what it quotes", "[driver]") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "gates.xml";
  write_junit(file.string(), {{"g/e: a", "a <= 1 & \"b\"", true, false},
                              {"g/e: b", "b fails", false, false},
                              {"g/e: c", "c is skipped: no <gpu>", false, true}});
  const std::string text = read_bytes(file.string());
  CHECK_THAT(text, Catch::Contains("tests=\"3\" failures=\"1\" skipped=\"1\"") &&
                       Catch::Contains("a &lt;= 1 &amp; &quot;b&quot;") &&
                       Catch::Contains("<skipped message=\"c is skipped: no &lt;gpu&gt;\"/>"));
}
