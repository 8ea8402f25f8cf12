// A run against the committed table, figure by figure.
#include "experiments/driver/agreement.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/application/probes.h"
#include "experiments/driver/kind.h"
#include "experiments/driver/tables.h"
#include "tests/experiments/worked_row.h"
#include "tests/temporary_folder.h"

using namespace airlight::experiments;
using airlight::test::not_rendered;
using Catch::Contains;

namespace {

Row row(const std::string& method, const Estimate& error) {
  Row r;
  r.scene = "s";
  r.method = method;
  r.measures = {{"rel_l2", error.value, error.low, error.high, 0, false}};
  return r;
}
Row exact(const std::string& method, double x) { return row(method, {x, x, x}); }

Agreement compared(const std::vector<Row>& ours, const std::vector<Row>& committed) {
  return compare_tables(ours, committed,
                        [](const Row&, const std::string& metric) { return metric.starts_with("ms"); });
}
Agreement compared(const Row& ours, const Row& committed) {
  return compared(std::vector{ours}, std::vector{committed});
}

}  // namespace

TEST_CASE("exact figures agree to three digits", "[agreement]") {
  CHECK(compared(exact("m", 0.0104), exact("m", 0.0104)).agrees());
  CHECK(compared(exact("m", 1.0009), exact("m", 1)).agrees());
  CHECK_FALSE(compared(exact("m", 1.0011), exact("m", 1)).agrees());
  CHECK_FALSE(compared(exact("m", 1), exact("m", -1)).agrees());
  CHECK_FALSE(compared(exact("m", 0), exact("m", 2e-6)).agrees());
  // Rounding of single precision is no figure.
  CHECK(compared(exact("m", 3e-8), exact("m", 9e-7)).agrees());
  // Not defined in one alone.
  CHECK_FALSE(compared(exact("m", std::nan("")), exact("m", 1)).agrees());
  CHECK(compared(exact("m", std::nan("")), exact("m", std::nan(""))).figures == 0);
  CHECK(text(compared({exact("m", 0.0123), exact("n", 1)}, {exact("m", 0.0104), exact("n", 1)}), "results/g/e") ==
        "DIFFERS from results/g/e: rel_l2 of s, m: 0.0123, committed 0.0104 (1 of 2 figures)");
}

TEST_CASE("noisy figures agree where their intervals touch, but for chance", "[agreement]") {
  CHECK(compared(row("m", {1, 0.8, 1.2}), row("m", {1.4, 1.2, 1.6})).apart.empty());
  CHECK(compared(row("m", {1, 0.8, 1.2}), exact("m", 1.1)).apart.empty());
  const Row low = row("m", {1, 0.8, 1.2}), high = row("m", {2, 1.8, 2.2});
  for (const auto& [ours, committed] : {std::pair(low, high), {high, low}}) {
    const Agreement a = compared(ours, committed);
    CHECK(a.noisy == 1);
    CHECK(a.apart.size() == 1);
    CHECK(a.agrees());  // one alone is chance
    CHECK(text(a, "t") ==
          "agrees with t: 0 of 1 figure; 1 of 1 noisy figure differ by more than their noise, no more "
          "than chance explains");
  }
  const auto many = [&](int n, int apart) {
    std::vector<Row> ours, committed;
    for (int i = 0; i < n; ++i) {
      ours.push_back(low);
      committed.push_back(i < apart ? high : low);
      ours.back().method = committed.back().method = std::to_string(i);
    }
    return compared(ours, committed);
  };
  CHECK(many(10, 1).agrees());
  CHECK_FALSE(many(10, 2).agrees());
  CHECK(many(100, 5).agrees());
  CHECK_FALSE(many(100, 6).agrees());
  CHECK_THAT(text(many(100, 6), "t"), Contains("rel_l2 of s, 2: 1, committed 2; and 3 more (6 of 100 figures)"));
}

TEST_CASE("rows that one table lacks are counted, and those of another device not compared", "[agreement]") {
  Row gpu = exact("gpu", 1), other_gpu = exact("gpu", 2), lacking = not_rendered("s", "lacking");
  gpu.device = "llvmpipe";
  other_gpu.device = "another";
  lacking.unavailable = true;
  const Agreement a = compared({exact("m", 1), exact("new", 1), exact("new 2", 1), gpu, lacking},
                               {exact("m", 1), exact("old", 1), other_gpu, exact("lacking", 1)});
  CHECK(a.agrees());
  CHECK(text(a, "t") ==
        "agrees with t: 1 of 1 figure; 2 rows only here; 1 row only there; "
        "2 rows not compared, unavailable here or of another device");
}

TEST_CASE("metrics that the committed table lacks are not compared", "[agreement]") {
  Row more = exact("m", 0.0104);
  more.measures.push_back({"rmse", 0.3, 0.3, 0.3, 0, false});
  CHECK(compared(more, exact("m", 0.0104)).agrees());
  CHECK(compared(more, exact("m", 0.0104)).figures == 1);
  CHECK_FALSE(compared(exact("m", 0.0104), more).agrees());
  // Where another row of that table has it, one without is a difference.
  Row other = more;
  other.method = "n";
  CHECK_FALSE(compared({more, other}, {exact("m", 0.0104), other}).agrees());
}

TEST_CASE("times are put in proportion and never differ", "[agreement]") {
  std::vector<Row> ours, committed;
  for (int i = 0; i < 11; ++i) {
    committed.push_back(exact(std::to_string(i), 1));
    committed.back().runs = 7;
    committed.back().seconds = {1, 1, 1};
    ours.push_back(committed.back());
    ours.back().seconds.value = 0.5 + 0.1 * i;
  }
  CHECK(text(compared(ours, committed), "t") == "agrees with t: 11 of 11 figures; times 1 times as long (0.6 to 1.4)");
  for (Row* r : {&ours[0], &committed[0]}) {
    r->runs = 0;
    const double ms = r == &ours[0] ? 30 : 10;
    r->measures = {{"ms_step", ms, ms, ms, 0, false}};
  }
  const Agreement a = compared(ours[0], committed[0]);
  CHECK(text(a, "t") == "has no figures to compare with t but times; times 3 times as long (3 to 3)");
  CHECK(a.times.value().value == 3);
}

TEST_CASE("probes say which of their figures depend on speed", "[agreement]") {
  const auto speed = [](const char* probe, const char* figure) { return is_speed(find_probe(probe, "here"), figure); };
  CHECK(speed("gaussian_fit", "frame_seconds"));
  CHECK(speed("gaussian_fit", "hash_ms"));
  CHECK_FALSE(speed("gaussian_fit", "evaluations"));  // their number
  CHECK_FALSE(speed("gaussian_fit", "rms_percent"));
  CHECK(speed("legendre_frame", "frames_per_second"));
  for (const auto& probe : all_probes()) {
    const auto figures = probe->figures();
    for (const std::string& figure : probe->speeds())
      CHECK(std::find(figures.begin(), figures.end(), figure) != figures.end());
  }
}

// The record that a run has written agrees with the run itself.
TEST_CASE("a record is read back as the rows that it is of", "[agreement]") {
  Outcome outcome;
  outcome.experiment.id = "g/e";
  outcome.experiment.kind = &find_kind("images");
  outcome.experiment.profile = "quick";
  outcome.rows = {row("m", {1, 0.8, 1.2}), exact("n", 0.3)};
  outcome.rows[1].seconds = {2, 1, 3};
  outcome.rows[1].runs = 3;
  const airlight::TemporaryFolder folder;
  folder.write("g/e/run.json", run_record(outcome, {}, {}).dump());
  const auto a = agreement_with(folder.path(), outcome);
  REQUIRE(a);
  CHECK(text(*a, "t") == "agrees with t: 2 of 2 figures; times 1 times as long (1 to 1)");
  outcome.experiment.id = "g/f";
  CHECK_FALSE(agreement_with(folder.path(), outcome));
}
