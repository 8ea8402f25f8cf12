// Rows, gates and timing rules, worked by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/driver/journal.h"
#include "experiments/driver/outcome.h"
#include "experiments/driver/run.h"
#include "experiments/driver/timing.h"
#include "tests/temporary_folder.h"

using namespace airlight::experiments;

namespace {

Row row(const std::string& scene, const std::string& method, const std::string& setting, const Estimate& error) {
  Row r;
  r.scene = scene;
  r.method = method;
  r.setting = setting;
  r.runs = 3;
  r.measures = {{"bias", 7, 7, 7, 0, false}, {"rel_l2", error.value, error.low, error.high, 0.25, false}};
  return r;
}

GateCase gate(const std::string& scene, const std::string& method, const std::string& setting, double at_most) {
  GateCase g;
  g.scene = scene;
  g.method = method;
  g.setting = setting;
  g.metric = "rel_l2";
  g.at_most = at_most;
  return g;
}

std::vector<GateResult> judged(const GateCase& g, const std::vector<Row>& rows) {
  Experiment e;
  e.id = "g/e";
  e.gates = {g};
  return judge(e, rows);
}

bool passes(const GateCase& g, const Estimate& error) {
  const auto results = judged(g, {row("s", "m", "", error)});
  REQUIRE(results.size() == 1);
  return results[0].passed;
}

}  // namespace

// A gate fails if the whole interval lies beyond the bound; what touches it passes.
TEST_CASE("gates by hand", "[driver]") {
  const GateCase most = gate("", "m", "", 0.5);
  CHECK(passes(most, {0.5, 0.5, 0.5}));
  CHECK(passes(most, {0.9, 0.5, 1.3}));
  CHECK_FALSE(passes(most, {0.6, std::nextafter(0.5, 1), 0.7}));
  CHECK_FALSE(passes(most, {0.6, 0.6, 0.6}));
  GateCase least = most;
  least.at_most = std::numeric_limits<double>::infinity();
  least.at_least = 0.5;
  CHECK(passes(least, {0.5, 0.5, 0.5}));
  CHECK(passes(least, {0.1, 0, 0.5}));
  CHECK_FALSE(passes(least, {0.4, 0.3, std::nextafter(0.5, 0)}));
  CHECK_FALSE(passes(least, {0.4, 0.4, 0.4}));
  // A bound of 0 holds for 0 alone.
  CHECK(passes(gate("", "m", "", 0), {0, 0, 0}));
  CHECK_FALSE(passes(gate("", "m", "", 0), {1e-300, 1e-300, 1e-300}));
}

TEST_CASE("gates find their rows", "[driver]") {
  const Estimate fine{0, 0, 0};
  const std::vector<Row> rows{row("s", "m", "", fine), row("s 2", "m", "4", fine), row("s 20", "m", "40", fine),
                              row("s2", "m", "4", fine), row("s", "n", "4", fine)};
  const auto count_of = [&](const std::string& scene, const std::string& method, const std::string& setting) {
    const auto results = judged(gate(scene, method, setting, 1), rows);
    for (const GateResult& r : results)
      if (!r.passed) return 0;  // there is no such row
    return int(results.size());
  };
  CHECK(count_of("", "m", "") == 4);
  CHECK(count_of("s", "m", "") == 3);  // a swept scene is called "name value"
  CHECK(count_of("s 2", "m", "") == 1);
  CHECK(count_of("s2", "m", "") == 1);
  CHECK(count_of("", "m", "4") == 2);
  CHECK(count_of("s", "m", "4") == 1);
  CHECK(count_of("s", "n", "") == 1);
  CHECK(count_of("t", "m", "") == 0);
  CHECK(count_of("s", "m", "5") == 0);
  // No row, no figure, not rendered: failures, not gaps.
  CHECK(judged(gate("t", "m", "", 1), rows).size() == 1);
  Row undefined = row("s", "m", "", {std::nan(""), 0, 0});
  CHECK_FALSE(judged(gate("", "m", "", 1), {undefined})[0].passed);
  Row not_rendered = rows[0];
  not_rendered.runs = 0;
  CHECK_FALSE(judged(gate("", "m", "", 1), {not_rendered})[0].passed);
  CHECK_FALSE(judged(gate("", "m", "", 1), {not_rendered})[0].skipped);
}

TEST_CASE("quantities of a row", "[driver]") {
  Row r = row("s", "m", "2.5", {3, 2, 4});
  r.seconds = {5, 4.5, 6};
  r.prepare_seconds = 0.125;
  r.counters = {{"rays", 12}};
  const auto of = [&](const char* name) { return quantity(r, name); };
  CHECK(of("rel_l2")->value == 3);
  CHECK(of("rel_l2")->low == 2);
  CHECK(of("rel_l2")->high == 4);
  CHECK(of("bias")->value == 7);
  CHECK_FALSE(of("rmse"));
  CHECK(of("seconds")->low == 4.5);
  CHECK(of("seconds")->high == 6);
  CHECK(of("prepare_seconds")->value == 0.125);
  CHECK(of("setting")->value == 2.5);
  CHECK_FALSE(of("parameter"));
  r.parameter = -1;
  CHECK(of("parameter")->value == -1);
  CHECK(of("counter.rays")->value == 12);
  CHECK_FALSE(of("counter.steps"));
  for (const char* word : {"", "2.5x", "S"}) {
    r.setting = word;
    CHECK_FALSE(of("setting"));
  }
  r.runs = 0;
  CHECK_FALSE(of("seconds"));
}

TEST_CASE("every figure of a row survives its record", "[driver]") {
  Row r = row("s", "m", "1", {3, 2, 4});
  r.measures[1].below_floor = true;
  r.seconds = {5, 4.5, 6};
  r.coverage = 0.96;
  r.mad = 0.25;
  r.prepare_seconds = 0.125;
  const Row back = row_from_json(nlohmann::json::parse(to_json(r).dump()));
  CHECK(back.measures[1].value == 3);
  CHECK(back.measures[1].low == 2);
  CHECK(back.measures[1].high == 4);
  CHECK(back.measures[1].floor == 0.25);
  CHECK(back.measures[1].below_floor);
  CHECK_FALSE(back.measures[0].below_floor);
  CHECK(back.seconds.value == 5);
  CHECK(back.seconds.low == 4.5);
  CHECK(back.seconds.high == 6);
  CHECK(back.coverage == 0.96);
  CHECK(back.mad == 0.25);
  CHECK(back.prepare_seconds == 0.125);
  CHECK(back.runs == 3);
}

// A journal keeps what it was given, whatever was torn before it; a changed character takes one line only.
TEST_CASE("journals forget damaged lines alone", "[driver]") {
  const airlight::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "rows.jsonl";
  Row a = row("s", "a", "", {1, 1, 1}), b = row("s", "b", "", {2, 2, 2});
  a.key = "key a";
  b.key = "key b";
  {
    Journal journal(file, true);
    journal.add(a);
    journal.add(b);
    REQUIRE(journal.find("key a"));
  }
  CHECK(Journal(file, true).find("key b")->method == "b");
  CHECK_FALSE(Journal(file, true).find("key c"));
  std::string text = airlight::read_bytes(file.string());
  const std::size_t at = text.find("\"method\":\"a\"");
  REQUIRE(at != std::string::npos);
  text[at + 10] = 'x';
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
  const Journal damaged(file, true);
  CHECK_FALSE(damaged.find("key a"));
  CHECK(damaged.find("key b"));
  Journal anew(file, false);
  CHECK_FALSE(anew.find("key b"));
  anew.begin_anew();
  CHECK_FALSE(Journal(file, true).find("key b"));
  anew.add(a);
  CHECK_FALSE(Journal(file, true).find("key b"));
  CHECK(Journal(file, true).find("key a"));
}

// Jobs of more than a second are run 5 times; others as often as asked for, within the budget.
TEST_CASE("how often a job is timed", "[driver]") {
  int count = 0;
  const auto job = [&] { ++count; };
  CHECK(time_runs({31, 0, 60, 0}, 1.01, job).runs == 5);
  CHECK(count == 5);
  CHECK(time_runs({31, 0, 60, 0}, 0.99, job).runs == 31);
  CHECK(time_runs({3, 0, 60, 0}, 1.01, job).runs == 3);
  // 7 runs of 0.14 s take 0.98 s, so they are certain; of 0.15 s 1.05 s, so they are not.
  CHECK(time_runs({31, 0, 0.1, 0}, 0.14, job).runs == 7);
  CHECK(time_runs({31, 0, 0.1, 0}, 0.15, job).runs == 1);
  CHECK(time_runs({31, 0, 0.1, 0}, 0.15, job).seconds.value == 0.15);
}

// Vectors of a method to come, which nothing can be compared with.
TEST_CASE("oracles that compare nothing fail a gate", "[driver]") {
  const airlight::TemporaryFolder folder;
  folder.write("vectors.json", R"({"part": "references", "vectors": [{"id": "a", "kind": "fluid", "input": {},)"
                               R"( "expected": {}, "accuracy": {}}]})");
  Experiment e;
  e.id = "g/e";
  e.kind = "oracles";
  e.profile = "quick";
  e.vector_files = {folder.path() / "vectors.json"};
  const Outcome outcome = run_experiment(e, {folder.path(), false, 1, false});
  REQUIRE(outcome.gates.size() == 1);
  CHECK_FALSE(outcome.gates[0].passed);
  CHECK_FALSE(outcome.gates[0].skipped);
  CHECK_THAT(outcome.gates[0].text, Catch::Contains("no number was compared"));
}

// Nine values: the median is the fifth, and the second and the eighth cover it with 1 - 2 (1 + 9) / 2^9 = 0.961.
TEST_CASE("a median and its ranks by hand", "[statistics]") {
  const Estimate e = median_estimate({9, 1, 8, 2, 70, 3, 6, 4, 5});
  CHECK(e.value == 5);
  CHECK(e.low == 2);
  CHECK(e.high == 9);
  CHECK(median_ranks(9).coverage == Approx(1 - 20.0 / 512));
  CHECK(median({4, 1, 2, 9}) == 3);
  CHECK(median_absolute_deviation({1, 2, 4, 9, 10}) == 3);  // of 3, 2, 0, 5, 6
  CHECK_THROWS(median({}));
  CHECK_THROWS(median_ranks(0));
}
