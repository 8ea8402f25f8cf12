// `experiment plan`: who computes what, and the script that GNU parallel runs.
#include "experiments/driver/schedule.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <set>

#include "experiments/driver/agreement.h"
#include "experiments/driver/expected_seconds.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace schedule_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

TEST_CASE("a plan has every job once, and no task takes more than 4/3 of the best", "[schedule]") {
  std::mt19937 random(5);
  std::exponential_distribution<double> lengths(0.1);
  for (const int tasks : {1, 2, 7, 50})
    for (const int count : {1, 3, 60}) {
      std::vector<double> seconds;
      for (int i = 0; i < count; ++i) seconds.push_back(lengths(random));
      const auto shares = experiments::balanced(seconds, tasks, 1e-3);
      CHECK(shares.size() == std::size_t(std::min(tasks, count)));
      std::multiset<std::size_t> seen;
      double longest = 0, total = 0;
      for (const auto& share : shares) {
        double sum = 0;
        for (const std::size_t job : share) sum += seconds[job], seen.insert(job);
        longest = std::max(longest, sum), total += sum;
      }
      CHECK(seen.size() == seconds.size());
      CHECK(std::set<std::size_t>(seen.begin(), seen.end()).size() == seconds.size());
      // No plan is shorter than its longest job, nor than an even share.
      const double least = std::max(*std::max_element(seconds.begin(), seconds.end()), total / tasks);
      CHECK(longest <= 2 * least);
      if (tasks == 1) CHECK(longest == Approx(total));
    }
  // Against the best of all plans.
  for (int trial = 0; trial < 50; ++trial) {
    constexpr int tasks = 3, jobs = 7, plans = 2187;  // 3^7
    std::vector<double> seconds;
    for (int i = 0; i < jobs; ++i) seconds.push_back(lengths(random));
    double best = infinity, got = 0;
    for (int plan = 0; plan < plans; ++plan) {
      double loads[tasks] = {};
      for (int i = 0, rest = plan; i < jobs; ++i, rest /= tasks) loads[rest % tasks] += seconds[std::size_t(i)];
      best = std::min(best, *std::max_element(loads, loads + tasks));
    }
    for (const auto& share : experiments::balanced(seconds, tasks, 1e-3)) {
      double sum = 0;
      for (const std::size_t job : share) sum += seconds[job];
      got = std::max(got, sum);
    }
    CHECK(got <= (4.0 / 3 - 1.0 / (3 * tasks)) * best * (1 + 1e-12));
  }
  // Graham's example, where the bound is met: 11 instead of 9.
  const auto worst = experiments::balanced({5, 5, 4, 4, 3, 3, 3}, 3, 1e-3);
  double longest = 0;
  for (const auto& share : worst) {
    double sum = 0;
    for (const std::size_t job : share) sum += std::vector<double>{5, 5, 4, 4, 3, 3, 3}[job];
    longest = std::max(longest, sum);
  }
  CHECK(longest == 11);
  CHECK(experiments::balanced({30, 30, 30, 30}, 100, 60).size() == 2);  // no task is shorter than asked
  CHECK(experiments::balanced({}, 4, 60).empty());
}

std::string several_marchers() {
  std::vector<Method> methods;
  for (const int n : {2, 4, 8, 16})
    methods.push_back({"march " + std::to_string(n), "ray_marcher", "0.9", "steps = " + std::to_string(n)});
  return against_quadrature(methods);
}

std::string marchers_against_paths(int samples) {
  std::string text = several_marchers();
  const auto replace = [&](const std::string& old, const std::string& by) {
    text.replace(text.find(old), old.size(), by);
  };
  replace("\"airlight\"", "\"mean\"");
  replace("renderer = \"deterministic\"",
          "renderer = \"path_tracer\"\nsettings = { max_order = 1, samples = " + std::to_string(samples) + " }");
  return text;
}

TEST_CASE("a plan lists references, rows and what gathers them", "[schedule][cli]") {
  const SmallProject project(box_of_fog(12, 9), several_marchers());
  const std::string plan = "experiment plan g/e --root . --tasks 3 --least 0.01 --without-times ";
  const Result told = run(plan + "--json", project);
  CAPTURE(told.out, told.err);
  REQUIRE(told.code == 0);
  const auto json = nlohmann::json::parse(told.out);
  CHECK(json["rows"] == 4);
  CHECK(json["guessed"] == nlohmann::json::array({"g/e"}));
  REQUIRE(json["stages"].size() == 3);
  CHECK(json["stages"][0]["name"] == "references");
  CHECK_THAT(json["stages"][0]["tasks"][0]["commands"][0].get<std::string>(),
             Contains("experiment reference g/e 'one'"));
  CHECK(json["stages"][1]["name"] == "rows");
  CHECK(json["stages"][1]["tasks"].size() == 3);
  CHECK(json["stages"][2]["name"] == "gather");
  // A reference that is there is not planned; rows that are timed are one task.
  REQUIRE(run("experiment reference g/e one --root .", project).code == 0);
  CHECK_THAT(run("experiment reference g/e one --root .", project).out, Contains("was there"));
  std::string text = several_marchers();
  text.replace(text.find("budget = 0"), 10, "budget = 0.01");
  project.write("experiments/g/e.toml", text);
  const auto timed = nlohmann::json::parse(run("experiment plan g/e --root . --tasks 3 --json", project).out);
  REQUIRE(timed["stages"].size() == 2);
  CHECK(timed["stages"][0]["name"] == "times");
  CHECK(timed["stages"][0]["alone"] == true);
  CHECK(timed["stages"][0]["tasks"].size() == 1);
  for (const char* wrong : {"experiment plan g/e --root .", "experiment plan g/e --root . --tasks 0",
                            "experiment plan g/e --root . --tasks 2 --slurm --json",
                            "experiment reference g/e nowhere --root .", "experiment reference g/e --root ."})
    CHECK(run(wrong, project).code == 2);
}

// One long reference, which three tasks share.
TEST_CASE("a plan cuts a long reference into ranges of samples", "[schedule][cli]") {
  std::string text = marchers_against_paths(448);
  const SmallProject project(box_of_fog(12, 9), text);
  REQUIRE(run("experiment run g/e --root . --cache once", project).code == 0);
  const std::string plan = "experiment plan g/e --root . --tasks 3 --least 0.001 ";
  const auto json = nlohmann::json::parse(run(plan + "--json", project).out);
  CHECK(json["guessed"].empty());
  CHECK(json["scaled_from_quick"].empty());
  REQUIRE(json["stages"][0]["name"] == "references");
  REQUIRE(json["stages"][1]["name"] == "films");
  std::string commands;
  for (const auto& task : json["stages"][0]["tasks"]) commands += task["commands"].dump();
  for (const char* range : {"--samples 0..128", "--samples 128..256", "--samples 256..384", "--samples 384..448"})
    CHECK_THAT(commands, Contains(range));
  const double pixels = 12 * 9, doubles = 3 * (7 + 2 * 6 + 16), ranges = 4;
  CHECK(json["bytes_of_ranges"] == ranges * pixels * doubles * 8);
  const std::string reference = "experiment reference g/e one --root . ";
  for (const char* range : {"384..448", "0..128", "256..384"})
    REQUIRE(run(reference + "--samples " + range, project).code == 0);
  REQUIRE(run(reference, project).code == 0);  // 128..256 as well
  const auto figures = [&](const std::string& options) {
    REQUIRE(run("experiment run g/e --root . " + options, project).code == 0);
    return run("results g/e --root . --metric rel_l2 " + options.substr(0, options.find(" --cache")), project).out;
  };
  CHECK(figures("--results joined") == figures("--results alone --cache once"));
  CHECK_THAT(run(reference + "--samples 0..64", project).out, Contains("was there"));
  for (const char* wrong : {"--samples 64", "--samples 0..512 --cache none", "--samples 1..64 --cache none"})
    CHECK(run(reference + wrong, project).code == 2);
}

// A film of 24 x 18 instead of 12 x 9, and twice as many samples.
TEST_CASE("seconds of the profile paper come from the profile quick where it has no record", "[schedule]") {
  std::string text = marchers_against_paths(64);
  text +=
      "[profile.paper]\nbudget = 0\nreference = { samples = 128 }\n"
      "overrides = { \"film.width\" = 24, \"film.height\" = 18 }\n";
  const SmallProject project(box_of_fog(12, 9), text);
  REQUIRE(run("experiment run g/e --root .", project).code == 0);
  const experiments::Folders folders{project.path(), project.path() / "results", project.path() / "results/cache"};
  const auto paper = experiments::read_experiment(folders, "g/e", "paper");
  const auto expected = experiments::expected_seconds(paper, folders, {{"one", {24 * 18, 128}}});
  CHECK(expected.from == experiments::ExpectedSeconds::From::quick_record);
  CHECK_FALSE(expected.guessed);
  const auto quick = experiments::read_experiment(folders, "g/e", "quick");
  const auto recorded = experiments::expected_seconds(quick, folders, {{"one", {12 * 9, 64}}});
  CHECK(recorded.from == experiments::ExpectedSeconds::From::own_record);
  CHECK(expected.references.at("one") == Approx(8 * recorded.references.at("one")));
  REQUIRE(expected.once.size() == 4);
  const auto rows = experiments::recorded_rows(project.path() / "results/g/e/run.json");
  REQUIRE(rows.has_value());
  double of_rows = 0;
  for (const auto& row : *rows) of_rows += row.prepare_seconds + 2 * row.seconds.value;
  const double of_each = (recorded.of_rows() - of_rows) / 4;
  REQUIRE(of_each >= 0);
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(expected.once[i] ==
          Approx((*rows)[i].prepare_seconds + 4 * (*rows)[i].seconds.value + of_each).epsilon(1e-9));
  // Without any record all rows are guessed.
  std::filesystem::remove_all(project.path() / "results/g");
  const auto guessed = experiments::expected_seconds(paper, folders, {});
  CHECK(guessed.from == experiments::ExpectedSeconds::From::nothing);
  CHECK(guessed.guessed);
}

TEST_CASE("GNU parallel runs a plan to the figures of one run", "[schedule][cli]") {
  const SmallProject project(box_of_fog(12, 9), several_marchers());
  if (run_command("parallel --version", project).code != 0) {
    WARN("test skipped: there is no GNU parallel");
    return;
  }
  const std::string wanted = "results g/e --root . --metric rel_l2 --results ";
  REQUIRE(run("experiment run g/e --root . --results whole", project).code == 0);
  const Result script = run("experiment plan g/e --root . --tasks 3 --least 0.01 --without-times --parallel", project);
  REQUIRE(script.code == 0);
  project.write("plan.sh", script.out);
  const Result ran = run_command("JOBS=2 sh plan.sh", project);
  CAPTURE(ran.out, ran.err);
  REQUIRE(ran.code == 0);
  CHECK(run(wanted + "airlight-plan/results", project).out == run(wanted + "whole", project).out);
  // What is done is not done again.
  const Result again = run_command("JOBS=2 sh plan.sh", project);
  CHECK(again.code == 0);
  CHECK_THAT(again.out, !Contains("done:"));
}

}  // namespace schedule_test
