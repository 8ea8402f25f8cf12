// scripts/test and scripts/reproduce fail where a gate does. The project around them is a small one, with nothing to
// build, no other tests and no report.
#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace cli_scripts_test {

using namespace airlight::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

struct Project : SmallProject {
  explicit Project(const std::string& bound)
      : SmallProject(box_of_fog(8, 6), both_backends(bound, "in_tests = true\n")) {
    for (const char* script : {"scripts/build", "scripts/report", "scripts/figures", "bin/ctest"}) {
      write(script, "#!/bin/sh\nexit 0\n");
      fs::permissions(path() / script, fs::perms::owner_all);
    }
    for (const char* script : {"scripts/test", "scripts/reproduce"}) fs::copy(root + "/" + script, path() / script);
    write("build/release/README", "");
    fs::create_symlink(program, path() / "build/release/airlight");
    write("tests/README", "");
  }

  Result run(const std::string& script) const {
    // From another folder than the project's.
    return run_command("cd bin && AIRLIGHT_GPU=none PATH='" + file("bin") + "':$PATH ../scripts/" + script, *this);
  }
};

}  // namespace

TEST_CASE("reproduce and test fail where a gate does, and name it", "[cli]") {
  const Project good("0.5"), bad("1e-30");
  const std::string name = "airlight: gate failed: g/e: one, CPU: rel_l2\n";
  for (const char* script : {"reproduce g", "test"}) {
    CAPTURE(script);
    const Result passes = good.run(script);
    CAPTURE(passes.out, passes.err);
    CHECK(passes.code == 0);
    CHECK(passes.err.empty());
    CHECK_THAT(passes.out, Contains("1 of 2 gates ok, 1 skipped"));
    const Result fails = bad.run(script);
    CAPTURE(fails.out, fails.err);
    CHECK(fails.code == 1);
    CHECK_THAT(fails.err, Contains(name));
    CHECK_THAT(fails.out, Contains("0 of 2 gates ok, 1 skipped"));
  }
  // scripts/test leaves the tables alone, prints what is not in order, and judges kept rows, too.
  fs::remove_all(good.path() / "results");
  const Result again = good.run("test");
  CHECK(again.code == 0);
  CHECK_FALSE(fs::exists(good.path() / "results"));
  CHECK_THAT(again.out, !Contains("ok       ") && Contains("skipped  g/e: one, GPU: rel_l2"));
}

}  // namespace cli_scripts_test
