// Comparisons of several rows, with answers worked by hand.
#include "experiments/driver/comparisons.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace comparisons_test {

using namespace airlight::experiments;

namespace {

Row row(const std::string& scene, const std::string& method, double seconds, double error, double half = 0) {
  Row r;
  r.scene = scene;
  r.method = method;
  r.runs = 1;
  r.seconds = {seconds, seconds, seconds};
  r.measures = {{"rel_l2", error, error - half, error + half, half, error - half <= 0}};
  return r;
}

Outcome outcome_of(const std::vector<Row>& rows) {
  Outcome outcome;
  outcome.rows = rows;
  outcome.experiment.metrics = {"rel_l2"};
  outcome.experiment.speed_ups = {{"slow", "fast", "rel_l2"}};
  return outcome;
}

std::string cell(const TextTable& table, std::size_t line, const std::string& column) {
  const auto found = std::find(table.at(0).begin(), table.at(0).end(), column);
  REQUIRE(found != table.at(0).end());
  return table.at(line).at(std::size_t(found - table.at(0).begin()));
}

// Times 1/e and e^-1/2 for errors e from 1 to 0.01.
const std::vector<Row> two_curves{row("s", "slow", 1, 1), row("s", "slow", 100, 0.01), row("s", "fast", 1, 1),
                                  row("s", "fast", 10, 0.01)};

}  // namespace

// The ratio of times goes from 1 to 10 evenly in logarithms: geometric mean 3.16. The ratio of errors at equal time
// (1/t over 1/t^2, t from 1 to 10) has an equal mean.
TEST_CASE("speed-ups of two curves by hand", "[comparisons]") {
  const TextTable table = equal_error_and_time(outcome_of(two_curves));
  REQUIRE(table.size() == 2);
  CHECK(cell(table, 1, "scene") == "s");
  CHECK(cell(table, 1, "method") == "fast");
  CHECK(cell(table, 1, "against") == "slow");
  CHECK_THAT(cell(table, 1, "times faster at equal error"), Catch::StartsWith("3.16"));
  CHECK(cell(table, 1, "range") == "1 to 10");
  CHECK(cell(table, 1, "over errors") == "0.01 to 1");
  CHECK_THAT(cell(table, 1, "times less error at equal time"), Catch::StartsWith("3.16"));
  CHECK(cell(table, 1, "over times") == "1 s to 10 s");
}

// 30 s before each picture of `fast` (t from 1 to 10): times 31 to 40 against 1 to 100, ratios 1/31 to 2.5.
TEST_CASE("speed-ups with preparation count it for each picture", "[comparisons]") {
  std::vector<Row> rows = two_curves;
  CHECK(cell(equal_error_and_time(outcome_of(rows)), 1, "times faster with preparation") == "3.16");
  for (Row& each : rows)
    if (each.method == "fast") each.prepare_seconds = 30;
  CHECK(quantity(rows[2], "total_seconds")->value == 31);
  CHECK(cell(equal_error_and_time(outcome_of(rows)), 1, "times faster with preparation") == "0.284");
  CHECK_THAT(cell(equal_error_and_time(outcome_of(rows)), 1, "times faster at equal error"), Catch::StartsWith("3.16"));
}

// A row whose interval reaches 0 says nothing but an upper end: with it `fast` would seem to reach 1e-4, and `slow`
// too.
TEST_CASE("rows below the noise floor are on no curve", "[comparisons]") {
  std::vector<Row> rows = two_curves;
  rows.push_back(row("s", "slow", 200, 0.005, 0.006));
  rows.push_back(row("s", "fast", 20, 0.001, 0.002));
  CHECK(equal_error_and_time(outcome_of(rows)) == equal_error_and_time(outcome_of(two_curves)));
  // Only such rows: there is no curve, and no line.
  CHECK(equal_error_and_time(outcome_of({rows[0], rows[5]})).size() == 1);
  // Now the figures are above their noise: 200 times 0.005 is a further point of 1/e.
  rows[4] = row("s", "slow", 200, 0.005, 0.004);
  CHECK(cell(equal_error_and_time(outcome_of(rows)), 1, "over errors") == "0.01 to 1");
  rows[5] = row("s", "fast", 20, 0.001, 0.0009);
  CHECK(cell(equal_error_and_time(outcome_of(rows)), 1, "over errors") == "0.005 to 1");
}

TEST_CASE("scenes, methods and metrics are kept apart", "[comparisons]") {
  std::vector<Row> rows = two_curves;
  rows.push_back(row("t", "slow", 7, 0.5));
  rows.push_back(row("t", "fast", 1, 0.5));
  rows.push_back(row("t", "other", 1e-9, 1e-9));
  Row unfinished = row("t", "fast", 0, 0.5);
  unfinished.runs = 0;
  rows.push_back(unfinished);
  for (Row& r : rows) r.measures.push_back({"bias", 0.3, 0, 1, 0, true});  // another metric below its floor
  const TextTable table = equal_error_and_time(outcome_of(rows));
  REQUIRE(table.size() == 3);
  CHECK(cell(table, 1, "range") == "1 to 10");
  CHECK(cell(table, 2, "scene") == "t");
  CHECK_THAT(cell(table, 2, "times faster at equal error"), Catch::StartsWith("7"));
  CHECK(cell(table, 2, "times less error at equal time") == "no common time");
}

// Errors from 4 to 0.04. In their middle, at 0.4, the times are 10 and sqrt(10): 6.84 s saved per render. 20 s more of
// preparation (medians of 5, 0, 1 and of 20, 22) are repaid after 20 / 6.84 = 2.92, so 3 renders.
TEST_CASE("how many renders repay a preparation", "[comparisons]") {
  std::vector<Row> rows = two_curves;
  for (Row& r : rows) r.measures[0].value = r.measures[0].low = r.measures[0].high = 4 * r.measures[0].value;
  const auto repaid = [&] {
    return cell(equal_error_and_time(outcome_of(rows)), 1, "preparation repaid after renders");
  };
  CHECK(repaid() == "1");
  rows[0].prepare_seconds = 5;
  rows[1].prepare_seconds = 0;
  rows.push_back(row("s", "slow", 1000, 8));
  rows.back().prepare_seconds = 1;
  rows[2].prepare_seconds = 20;
  rows[3].prepare_seconds = 22;
  rows.push_back(row("s", "fast", 1, 1));  // never rendered
  rows.back().prepare_seconds = 1000;
  rows.back().runs = 0;
  CHECK(repaid() == "3");
  // Longer to prepare and slower: never. Slower, and quicker to prepare: never either.
  Outcome swapped = outcome_of(rows);
  swapped.experiment.speed_ups = {{"fast", "slow", "rel_l2"}};
  CHECK(cell(equal_error_and_time(swapped), 1, "preparation repaid after renders") == "never");
  for (Row& r : swapped.rows) r.prepare_seconds = r.method == "slow" ? 30 : 0;
  CHECK(cell(equal_error_and_time(swapped), 1, "preparation repaid after renders") == "never");
  // All times a thousandth: the same.
  for (Row& r : rows) {
    r.seconds = {r.seconds.value / 1000, r.seconds.low / 1000, r.seconds.high / 1000};
    r.prepare_seconds /= 1000;
  }
  CHECK(repaid() == "3");
  for (Row& r : rows) r.prepare_seconds = 0;
  CHECK(repaid() == "1");
  // Nothing saved: never, unless nothing was spent.
  rows = {row("s", "slow", 2, 1), row("s", "fast", 2, 1)};
  CHECK(repaid() == "1");
  rows[1].prepare_seconds = 0.5;
  CHECK(repaid() == "never");
}

// The fastest of `fast` (1 s, 0.05) is closer than all of `slow`, whose closest is (4 s, 0.1): a quarter of its time.
TEST_CASE("curves without a common error are told apart in words", "[comparisons]") {
  const TextTable table = equal_error_and_time(outcome_of(
      {row("s", "slow", 2, 0.5), row("s", "slow", 4, 0.1), row("s", "fast", 1, 0.05), row("s", "fast", 5, 0.01)}));
  CHECK(table.at(1).at(4) ==
        "none: even the fastest of fast has a smaller error (0.05) than the closest of slow (0.1), in 0.25 times its "
        "time; its slowest takes 2.5 times as long as the fastest of slow");
  Row a = row("s", "slow", 8, 0), b = row("s", "fast", 4, 0);
  a.measures[0].below_floor = b.measures[0].below_floor = false;  // exact
  CHECK_THAT(equal_error_and_time(outcome_of({a, b})).at(1).at(4), Catch::StartsWith("2, both with error 0"));
}

// One front per scene: (1, 1), (2, 0.5) and, because the intervals overlap, (3, 0.5 +- 0.2). (4, 2) is beaten twice.
TEST_CASE("the front is that of each scene", "[comparisons]") {
  std::vector<Row> rows{
      row("s", "a", 1, 1),        row("s", "a", 4, 2),   row("s", "b", 2, 0.5),
      row("s", "b", 3, 0.5, 0.2), row("t", "a", 9, 9),   row("s", "c", 0, 0),
      row("t", "b", 10, 9.5),     row("s", "d", 5, 0.6), row("s", "e", 0.1, std::nan(""))};  // rendered, not compared
  rows[5].runs = 0;                                                                          // not rendered
  CHECK(on_front(outcome_of(rows)) == std::vector<bool>{true, false, true, true, true, false, false, false, false});
  Outcome none = outcome_of(rows);
  none.experiment.metrics.clear();
  CHECK(on_front(none) == std::vector<bool>(9, false));
}

TEST_CASE("durations choose their unit", "[comparisons]") {
  CHECK(duration(0.000999) == "999 us");
  CHECK(duration(0.001) == "1 ms");
  CHECK(duration(0.9994) == "999 ms");
  CHECK(duration(1) == "1 s");
  CHECK(duration(75.26) == "75.3 s");
}

}  // namespace comparisons_test
