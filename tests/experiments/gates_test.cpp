// Figures that pass their gates and figures that do not, worked by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "experiments/driver/junit.h"
#include "experiments/driver/outcome.h"
#include "experiments/driver/run.h"
#include "tests/experiments/worked_row.h"
#include "tests/temporary_folder.h"

namespace gates_test {

using namespace airlight::experiments;
using airlight::test::not_rendered;
using airlight::test::row;

namespace {

GateCase gate(const std::string& scene, const std::string& method, const std::string& setting, double at_most) {
  GateCase g;
  g.scene = scene;
  g.method = method;
  g.setting = setting;
  g.metric = "rel_l2";
  g.at_most = at_most;
  return g;
}

std::vector<GateResult> judged(const std::vector<GateCase>& gates, const std::vector<Row>& rows) {
  Experiment e;
  e.id = "g/e";
  e.gates = gates;
  return judge(e, rows);
}

// The verdict on that row alone.
std::string verdict(const std::vector<GateCase>& gates, const Row& r) {
  const auto results = judged(gates, {r});
  REQUIRE(results.size() == 1);
  return word(results[0]);
}

bool passes(const GateCase& g, const Estimate& error) { return verdict({g}, row("s", "m", "", error)) == "ok"; }

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
    const auto results = judged({gate(scene, method, setting, 1)}, rows);
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
  CHECK(judged({gate("t", "m", "", 1)}, rows).size() == 1);
  const GateCase any = gate("", "m", "", 1);
  CHECK(verdict({any}, row("s", "other", "", fine)) == "FAILED");
  CHECK(verdict({any}, row("s", "m", "", {std::nan(""), 0, 0})) == "FAILED");
  CHECK(verdict({any}, row("s", "m", "", {std::nan(""), std::nan(""), std::nan("")})) == "FAILED");
  CHECK(verdict({any}, not_rendered("s", "m")) == "FAILED");
}

TEST_CASE("a gate says what kind of figure it judged, and the figure", "[driver]") {
  Row r = row("s", "m", "8", {0.25, 0.125, 0.5});
  r.seconds = {5, 4.5, 6};
  r.counters = {{"rays", 12}};
  for (const char* name : {"objections", "exact", "spread"}) r.measures.push_back({name, 1, 1, 1, 0, false});
  r.measures.back().high = 2;
  const auto judged_on = [&](const std::string& metric) {
    GateCase g = gate("", "m", "", 100);
    g.metric = metric;
    return judged({g}, {r}).at(0);
  };
  CHECK(judged_on("seconds").kind == "time");
  CHECK(judged_on("prepare_seconds").kind == "time");
  CHECK(judged_on("counter.rays").kind == "counter");
  CHECK(judged_on("objections").kind == "Monte Carlo");  // whatever its interval
  CHECK(judged_on("rel_l2").kind == "Monte Carlo");
  CHECK(judged_on("spread").kind == "Monte Carlo");
  CHECK(judged_on("exact").kind == "deterministic");
  r.measures[0].floor = 0.1;  // of the bias, whose interval is a point
  CHECK(judged_on("bias").kind == "Monte Carlo");
  CHECK(judged_on("seconds").text == "g/e: s, m 8: seconds <= 100: 5 [4.5, 6]");
  const GateResult result = judged_on("rel_l2");
  CHECK((result.scene == "s" && result.method == "m" && result.setting == "8" && result.metric == "rel_l2"));
  CHECK((result.upper && result.bound == 100 && result.measured->low == 0.125));
  CHECK(result.text == "g/e: s, m 8: rel_l2 <= 100: " + text(r.measures[1]));
}

TEST_CASE("a bound by row stands for that of the gate, on the device where it was measured", "[driver]") {
  GateCase law = gate("", "", "", 0.1), bound = gate("s", "m", "", 0.02);
  bound.by_row = true;
  Row r = row("s", "m", "", {0.03, 0.03, 0.03});
  CHECK(verdict({law}, r) == "ok");
  CHECK(verdict({bound, law}, r) == "FAILED");
  r.device = "another";
  CHECK(verdict({bound, law}, r) == "ok");  // the gate's own bound
  law.at_most = airlight::infinity;
  CHECK(verdict({bound, law}, r) == "skipped");  // there is none for this device
  r.device.clear();
  CHECK(verdict({law}, r) == "FAILED");  // nothing bounds a figure that a gate covers
  // Names are exact: "s 2" is another scene, and a line whose row has gone fails.
  bound.scene = "gone";
  CHECK_FALSE(judged({bound}, {row("gone 2", "m", "", {0, 0, 0})})[0].passed);
}

TEST_CASE("gates on what the machine lacks are skipped", "[driver]") {
  Row lacking = not_rendered("s", "m");
  lacking.note = "not available on this machine: gpu";
  Row asked_for = lacking;  // by name
  lacking.unavailable = true;
  const auto results = judged({gate("", "m", "", 0.1)}, {lacking, row("t", "m", "", {0.01, 0, 0.02}), asked_for});
  REQUIRE(results.size() == 3);
  CHECK(results[0].skipped);
  CHECK_THAT(results[0].text, Catch::Contains("is skipped: not available on this machine"));
  const GateCounts counts = count(results);
  CHECK(counts.skipped == 1);
  CHECK(counts.passed == 1);
  CHECK(counts.failed == 1);
  CHECK(std::string(word(results[2])) == "FAILED");
}

TEST_CASE("a JUnit report escapes what it quotes", "[driver]") {
  const airlight::TemporaryFolder folder;
  const auto file = folder.path() / "gates.xml";
  std::vector<GateResult> gates{{"g/e: a", "a <= 1 & \"b\"", true, false},
                                {"g/e: b", "b fails", false, false},
                                {"g/e: c", "c is skipped: no <gpu>", false, true}};
  gates[0].seconds = 1.25;
  write_junit(file.string(), gates);
  const std::string text = airlight::read_bytes(file.string());
  CHECK_THAT(text, Catch::Contains("tests=\"3\" failures=\"1\" skipped=\"1\"") &&
                       Catch::Contains("name=\"g/e: a\" time=\"1.250\"") &&
                       Catch::Contains("a &lt;= 1 &amp; &quot;b&quot;") &&
                       Catch::Contains("<skipped message=\"c is skipped: no &lt;gpu&gt;\"/>"));
}

}  // namespace gates_test
