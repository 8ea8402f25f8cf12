// scripts/test and scripts/reproduce fail where a gate does. The project around them is a small one, with nothing to
// build, no other tests and no report.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "tests/experiments/run_program.h"

using airlight::read_bytes;
using airlight::TemporaryFolder;
using airlight::test::program;
using airlight::test::Result;
using airlight::test::root;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

struct Project : TemporaryFolder {
  explicit Project(const std::string& bound) {
    for (const char* script : {"scripts/build", "scripts/report", "scripts/figures", "bin/ctest"}) {
      write(script, "#!/bin/sh\nexit 0\n");
      fs::permissions(path() / script, fs::perms::owner_all);
    }
    for (const char* script : {"scripts/test", "scripts/reproduce"}) fs::copy(root + "/" + script, path() / script);
    write("build/release/README", "");
    fs::create_symlink(program, path() / "build/release/airlight");
    write("tests/README", "");
    write("experiments/README.md", "");
    write("experiments/scenes/one.toml", R"([film]
width = 8
height = 6
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
[[light]]
type = "point"
position = [1.5, 2, 1]
intensity = 5
[[medium]]
type = "homogeneous"
sigma_t = 0.5
region = { type = "box", lo = [-1, -1, -1], hi = [1, 1, 1] }
)");
    write("experiments/g/e.toml", R"(title = "Both backends"
in_tests = true
layer = "airlight"
metrics = ["rel_l2"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "deterministic"
[[method]]
name = "CPU"
renderer = "ray_marcher"
[[method]]
name = "GPU"
renderer = "ray_marcher_gpu"
[profile.quick]
budget = 0
[[gate]]
method = "CPU"
metric = "rel_l2"
at_most = )" + bound + R"(
[[gate]]
method = "GPU"
metric = "rel_l2"
at_most = 0.5
)");
  }

  Result run(const std::string& script) const {
    const std::string out = file("stdout"), err = file("stderr");
    const int status = std::system(("AIRLIGHT_GPU=none PATH='" + file("bin") + "':$PATH '" + file("scripts/") + script +
                                    " >'" + out + "' 2>'" + err + "'")
                                       .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_bytes(out), read_bytes(err)};
  }
};

}  // namespace

TEST_CASE("reproduce and test fail where a gate does, and name it", "[cli]") {
  const Project good("0.5"), bad("1e-30");
  const std::string name = "airlight: gate failed: g/e: one, CPU: rel_l2\n";
  for (const char* script : {"reproduce' g", "test'"}) {
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
  const Result again = good.run("test'");
  CHECK(again.code == 0);
  CHECK_FALSE(fs::exists(good.path() / "results"));
  CHECK_THAT(again.out, !Contains("ok       ") && Contains("skipped  g/e: one, GPU: rel_l2"));
}
