// `experiment run --rows` and `experiment gather`: an experiment in parts gives the table of one run.
#include <catch2/catch.hpp>

#include "experiments/driver/journal.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace parts_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

std::string marcher(const std::vector<int>& steps) {
  std::vector<Method> methods;
  for (const int n : steps)
    methods.push_back({"march " + std::to_string(n), "ray_marcher", "0.9", "steps = " + std::to_string(n)});
  return against_quadrature(methods);
}

std::string figures(const SmallProject& project, const std::string& results) {
  const Result told = run("results g/e --root . --results " + results + " --metric rel_l2", project);
  CAPTURE(told.err);
  REQUIRE(told.code == 0);
  return told.out;
}

TEST_CASE("an experiment in parts gives the figures of one run", "[cli]") {
  const SmallProject project(box_of_fog(12, 9), marcher({2, 4, 8, 16, 32}));
  REQUIRE(run("experiment run g/e --root . --results whole", project).code == 0);
  const auto part = [&](const std::string& rows, const std::string& folder) {
    return run("experiment run g/e --root . --rows " + rows + " --journal " + folder, project);
  };
  const Result first = part("1/2", "p1");
  CAPTURE(first.out, first.err);
  REQUIRE(first.code == 0);
  CHECK_THAT(first.out, Contains("3 rows of part 1/2"));
  CHECK_FALSE(project.has("p1/g/e/table.md"));

  const std::string gather = "experiment gather g/e --root . --results gathered ";
  const Result missing = run(gather + "p1", project);
  CHECK(missing.code == 2);
  CHECK_THAT(missing.err, Contains("g/e: 2 of 5 rows are missing, the first is 'march 4 on one'"));
  CHECK_FALSE(project.has("gathered/g/e/table.md"));

  REQUIRE(part("2/2", "p2").code == 0);
  const Result all = run(gather + "p1 p2", project);
  CAPTURE(all.out, all.err);
  REQUIRE(all.code == 0);
  CHECK_THAT(all.out, Contains("5 rows of 2 folders, 5 of 5 gates ok: gathered/g/e/table.md"));
  CHECK(figures(project, "gathered") == figures(project, "whole"));
  CHECK(project.has("gathered/images/g/e/one/march_4.exr"));
}

TEST_CASE("parts that contradict each other, that are of another program, or no parts are refused", "[cli]") {
  const SmallProject project(box_of_fog(12, 9), marcher({2, 4, 8, 16, 32}));
  REQUIRE(run("experiment run g/e --root . --rows 1/1 --journal p1", project).code == 0);
  const experiments::Journal journal(project.path() / "p1/rows/g/e.quick.jsonl", true);
  REQUIRE(journal.rows().size() == 5);
  experiments::Row row = journal.rows().begin()->second;
  row.measures.at(0).value *= 1.001;
  experiments::Journal(project.path() / "wrong/rows/g/e.quick.jsonl", false).add(row);
  row.key[0] = row.key[0] == '0' ? '1' : '0';  // as another program has it
  row.figures_key = row.key;
  experiments::Journal(project.path() / "other/rows/g/e.quick.jsonl", false).add(row);
  const auto refused = [&](const std::string& command, const std::string& words) {
    const Result result = run("experiment " + command, project);
    CAPTURE(command, result.err);
    CHECK(result.code == 2);
    CHECK(result.error_lines() == 1);
    CHECK_THAT(result.err, Contains(words));
    CHECK_FALSE(project.has("out/g/e/table.md"));
  };
  const std::string gather = "gather g/e --root . --results out ";
  refused(gather + "p1 wrong", "p1 and wrong contradict each other in row 'one march");
  refused(gather + "other", "5 of 5 rows are missing");
  refused(gather + "nowhere", "nowhere: no rows of g/e");
  refused(gather, "FOLDER is missing");
  for (const char* rows : {"0/2", "3/2", "1/2x", "a/b", "1/0", "0", "3-2", "1,,2", "2,", "1-", "2x"})
    refused("run g/e --root . --journal p --rows " + std::string(rows), "expected I/N with I from 1 to N");
  refused("run g/e --root . --rows 1/2", "belong together");
  refused("run g/e --root . --journal p", "belong together");
}

TEST_CASE("rows of several computers give errors without times", "[cli]") {
  const SmallProject project(box_of_fog(12, 9), marcher({2, 4, 8, 16, 32}));
  REQUIRE(run("experiment run g/e --root . --results whole", project).code == 0);
  REQUIRE(run("experiment run g/e --root . --rows 1-2,5 --journal p1", project).code == 0);
  REQUIRE(run("experiment run g/e --root . --rows 3,4 --journal p2", project).code == 0);
  // Another processor: its rows have other keys.
  const experiments::Journal journal(project.path() / "p2/rows/g/e.quick.jsonl", true);
  REQUIRE(journal.rows().size() == 2);
  experiments::Journal other(project.path() / "far/rows/g/e.quick.jsonl", false);
  for (auto [key, row] : journal.rows()) {
    row.key[0] = row.key[0] == '0' ? '1' : '0';
    row.made_on = "Another, avx2, 64 threads on n7";
    other.add(row);
  }
  std::filesystem::copy(project.path() / "p2/images", project.path() / "far/images",
                        std::filesystem::copy_options::recursive);
  const Result mixed = run("experiment gather g/e --root . --results mixed p1 far", project);
  CAPTURE(mixed.out, mixed.err);
  REQUIRE(mixed.code == 0);
  CHECK_THAT(mixed.out, Contains("Times are left out: ") && Contains("2 rows on Another, avx2, 64 threads on n7"));
  CHECK(figures(project, "mixed") == figures(project, "whole"));
  const std::string page = read_bytes(project.file("mixed/g/e/table.md"));
  CHECK_THAT(page, Contains("Times are left out"));
  CHECK_THAT(page, !Contains("| time"));

  REQUIRE(run("experiment run g/e --root . --rows 1/1 --journal untimed --without-times", project).code == 0);
  const Result untimed = run("experiment gather g/e --root . --results untimed-table untimed", project);
  CAPTURE(untimed.out, untimed.err);
  REQUIRE(untimed.code == 0);
  CHECK_THAT(untimed.out, Contains("Times are left out: 5 rows without times"));
  CHECK(figures(project, "untimed-table") == figures(project, "whole"));
}

TEST_CASE("SIGUSR1 ends a part after the row in hand, and the part goes on", "[cli]") {
  std::vector<int> steps;
  for (int i = 0; i < 20; ++i) steps.push_back(30000 + i);
  const SmallProject project(box_of_fog(24, 18), marcher(steps));
  const std::string part = "experiment run g/e --root . --rows 1/1 --journal p1 --threads 1";
  const Result ended = run_command("timeout --preserve-status -s USR1 1 '" + program + "' " + part, project);
  CAPTURE(ended.out, ended.err);
  CHECK(ended.code == 130);
  const experiments::Journal before(project.path() / "p1/rows/g/e.quick.jsonl", true);
  CHECK(before.rows().size() < 20);
  const Result rest = run(part, project);
  REQUIRE(rest.code == 0);
  std::size_t kept = 0;
  for (std::size_t at = rest.out.find("  kept: "); at != std::string::npos; at = rest.out.find("  kept: ", at + 1))
    ++kept;
  CHECK(kept == before.rows().size());
  CHECK(experiments::Journal(project.path() / "p1/rows/g/e.quick.jsonl", true).rows().size() == 20);
}

}  // namespace parts_test
