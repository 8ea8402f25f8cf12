// Printed values beside measured ones, and the sentence that quotes them.
#include "experiments/driver/expected.h"

#include <catch2/catch.hpp>

#include "experiments/application/json_value.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/tables.h"
#include "scene/base/error.h"
#include "tests/experiments/worked_row.h"

using namespace airlight::experiments;
using airlight::test::not_rendered;
using airlight::test::row;

namespace {

ExpectedCase expect(const std::string& method, const std::string& metric, const std::string& unit = "",
                    const std::string& baseline = "") {
  ExpectedCase e;
  e.what = metric;
  e.paper = "printed";
  e.scene = "s";
  e.method = method;
  e.metric = metric;
  e.unit = unit;
  e.baseline = baseline;
  return e;
}

Row timed(const std::string& method, double seconds, const Estimate& error) {
  Row r = row("s", method, "", error);
  r.seconds = {seconds, 0.9 * seconds, 1.1 * seconds};
  r.width = 40;
  r.height = 30;
  r.counters = {{"rays", 123456}};
  return r;
}

// At equal error the first curve of two points takes 10 times as long as the second at all errors.
Outcome two_curves() {
  Outcome outcome;
  outcome.experiment.kind = &find_kind("images");
  outcome.experiment.metrics = {"bias", "rel_l2"};
  for (const auto& [method, times] : {std::pair("slow", 10.0), {"fast", 1.0}})
    for (const double error : {0.1, 0.01})
      outcome.rows.push_back(timed(method, 1e-3 * times / error, {error, error, error}));
  return outcome;
}

std::string said(const Estimate& error, const ExpectedCase& e) {
  Outcome outcome;
  outcome.experiment.kind = &find_kind("images");
  outcome.rows = {timed("m", 0.0021, error)};
  return figure_text(outcome, e);
}

}  // namespace

TEST_CASE("figures for people have two digits and a unit", "[expected]") {
  const Estimate exact{0.03302, 0.03302, 0.03302};
  CHECK(said(exact, expect("m", "rel_l2")) == "3.3 %");  // an error is a share: percent unless another unit is named
  CHECK(said(exact, expect("m", "rel_l2", "percent")) == "3.3 %");
  CHECK(said(exact, expect("m", "rel_l2", "times")) == "0.033 times");
  CHECK(said({1.234, 1, 2}, expect("m", "rel_l2")) == "120 %");
  CHECK(said({0.0996, 0, 1}, expect("m", "rel_l2")) == "10 %");
  CHECK(said({0.000123, 0, 1}, expect("m", "rel_l2")) == "0.012 %");
  CHECK(said({0, 0, 0}, expect("m", "rel_l2")) == "0 %");
  CHECK(said(exact, expect("m", "bias")) == "700 %");
  CHECK(said(exact, expect("m", "seconds")) == "2.1 ms");
  CHECK(said(exact, expect("m", "seconds", "s")) == "0.0021 s");
  CHECK(said(exact, expect("m", "seconds", "us")) == "2100 us");
  CHECK(said(exact, expect("m", "seconds", "per second")) == "480 per second");
  CHECK(said(exact, expect("m", "counter.rays")) == "123456");
  for (const ExpectedCase& e : {expect("m", "p99"), expect("n", "rel_l2"), expect("m", "counter.steps")})
    CHECK(said(exact, e) == "not available");
}

TEST_CASE("a unit must fit its figure", "[expected]") {
  for (const char* unit : {"s", "ms", "us", "ns", "per second"}) {
    CHECK(fits_unit(expect("m", "frame_seconds", unit)));
    CHECK(fits_unit(expect("m", "ms_step", unit)));
    CHECK_FALSE(fits_unit(expect("m", "rel_l2", unit)));
  }
  CHECK_FALSE(fits_unit(expect("m", "seconds", "percent")));
  CHECK(fits_unit(expect("m", "rms_percent", "percent")));
  CHECK_FALSE(fits_unit(expect("m", "rms_percent", "times")));
  CHECK(fits_unit(expect("m", "ratio", "times")));
  CHECK_FALSE(fits_unit(expect("m", "rel_l2", "percent", "b")));
}

TEST_CASE("a figure that a probe gives in a unit keeps it", "[expected]") {
  Outcome outcome;
  outcome.rows = {not_rendered("s", "m")};
  for (const char* name : {"rms_percent", "hash_ms", "frame_seconds", "ratio"})
    outcome.rows[0].measures.push_back({name, 2.5, 2.4, 2.6, 0, false});
  CHECK(figure_text(outcome, expect("m", "rms_percent")) == "2.5 %");
  CHECK(figure_text(outcome, expect("m", "rms_percent", "percent")) == "2.5 %");
  CHECK(figure_text(outcome, expect("m", "hash_ms")) == "2.5 ms");
  CHECK(figure_text(outcome, expect("m", "hash_ms", "s")) == "0.0025 s");
  CHECK(figure_text(outcome, expect("m", "frame_seconds")) == "2.5 s");
  CHECK(figure_text(outcome, expect("m", "frame_seconds", "ms")) == "2500 ms");
  CHECK(figure_text(outcome, expect("m", "ratio")) == "2.5");
  CHECK(figure_text(outcome, expect("m", "ratio", "times")) == "2.5 times");
}

// Slow: errors 0.1 and 0.01 in 0.1 and 1 s. Close: 0.005 in 0.2 s.
TEST_CASE("without a common error the expected speed-up is a bound from below", "[expected]") {
  Outcome outcome = two_curves();
  outcome.rows.resize(2);
  outcome.rows[0].seconds = {0.1, 0.1, 0.1};
  outcome.rows[1].seconds = {1, 1, 1};
  outcome.rows.push_back(timed("close", 0.2, {0.005, 0.005, 0.005}));
  CHECK(figure_text(outcome, expect("close", "rel_l2", "", "slow")) == "at least 5.0 times");
  CHECK(figure_text(outcome, expect("slow", "rel_l2", "", "close")) == "not available");  // it never gets so close
  outcome.experiment.expected = {expect("close", "rel_l2", "", "slow")};
  CHECK(expected_table(outcome).at(1).at(2) == "at least 5.0 times");
}

TEST_CASE("an expected speed-up is the geometric mean at equal error", "[expected]") {
  Outcome outcome = two_curves();
  CHECK(figure_text(outcome, expect("fast", "rel_l2", "", "slow")) == "10 times");
  CHECK(figure_text(outcome, expect("slow", "rel_l2", "times", "fast")) == "0.10 times");
  outcome.rows.resize(2);  // of the other method nothing was measured
  CHECK(figure_text(outcome, expect("fast", "rel_l2", "", "slow")) == "not available");
  for (const char* method : {"exact", "slower"})
    outcome.rows.push_back(timed(method, method[0] == 'e' ? 1 : 3, {0, 0, 0}));
  CHECK(figure_text(outcome, expect("exact", "rel_l2", "", "slower")) == "3.0 times");  // both without error
}

TEST_CASE("what is below the noise is an upper end", "[expected]") {
  Outcome outcome;
  outcome.rows = {row("s", "m", "", {0.001, -0.001, 0.0021})};
  outcome.rows[0].measures[1].below_floor = true;
  CHECK(figure_text(outcome, expect("m", "rel_l2")) == "at most 0.21 %");
}

TEST_CASE("printed and measured stand side by side", "[expected]") {
  Outcome outcome = two_curves();
  outcome.rows.push_back(not_rendered("s", "gpu"));
  outcome.rows.back().note = "not available on this machine: gpu";
  ExpectedCase words;
  words.what = "what";
  words.paper = "no visible difference";
  outcome.experiment.expected = {words,
                                 expect("slow", "rel_l2"),
                                 expect("slow", "rel_l2", "percent"),
                                 expect("slow", "seconds"),
                                 expect("slow", "seconds", "ms"),
                                 expect("fast", "rel_l2", "", "slow"),
                                 expect("gpu", "rel_l2", "percent"),
                                 expect("none", "rel_l2")};
  const TextTable table = expected_table(outcome);
  std::vector<std::string> ours;
  for (const auto& line : table) ours.push_back(line.at(2));
  CHECK(ours == std::vector<std::string>{"ours", "", "0.1", "10 %", "100 ms [90 ms, 110 ms] at 40x30, 10 per second",
                                         "100 ms [90 ms, 110 ms] at 40x30", "10 times",
                                         "not available on this machine: gpu", "not in this profile"});
}

TEST_CASE("a summary quotes the measured figures", "[expected]") {
  Outcome outcome = two_curves();
  Experiment& e = outcome.experiment;
  e.title = "T";
  CHECK(summary_text(outcome).empty());
  e.summary = "The fast one errs by {2}, {1} faster ({1}); {3}.";
  e.expected = {expect("fast", "rel_l2", "", "slow"), expect("fast", "rel_l2"), expect("none", "rel_l2")};
  const std::string sentence = "The fast one errs by 10 %, 10 times faster (10 times); not available.";
  CHECK(summary_text(outcome) == sentence);
  outcome.complete = true;
  const std::vector<NamedTable> all = tables(outcome);
  const nlohmann::json record = run_record(outcome, all, {});
  CHECK_THAT(table_markdown(e, all, record), Catch::StartsWith("# T\n\n" + sentence + "\n\n"));
  CHECK(record["summary"] == sentence);
}

TEST_CASE("braces of a summary that do not match are refused", "[expected]") {
  const auto fill = [](const std::string& text) {
    return fill_in(text, [](std::size_t n) { return "<" + std::to_string(n) + ">"; });
  };
  CHECK(fill("") == "");
  CHECK(fill("a {1}{12}") == "a <1><12>");
  for (const char* bad : {"{", "}", "a {1", "1} a", "{}", "{a}", "{-1}", "{1 }", "{{1}}"}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(fill(bad), airlight::Error);
  }
}
