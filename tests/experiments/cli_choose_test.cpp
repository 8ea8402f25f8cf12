// `airlight choose`: bad options in one line, a ranking whose command lines run, and errors that depend on no thread.
#include <catch2/catch.hpp>
#include <regex>

#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"
#include "tests/texts.h"

namespace cli_choose_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

// Few rows, which take no time.
struct Project : SmallProject {
  Project() : SmallProject(box_of_fog(48, 36)) {
    write("experiments/common/all_orders.toml", R"(title = "Rows"
metrics = ["rel_l2"]
[reference]
renderer = "path_tracer"
[[scene]]
file = "scenes/one.toml"
[[method]]
name = "marched"
renderer = "ray_marcher"
sweep = { key = "steps", values = [2, 32] }
[[method]]
name = "paths"
renderer = "path_tracer"
settings = { stream = 1, samples = 4 }
[[method]]
name = "converted"
renderer = "wavelet_fog"
convert = { to = "fogmap", cells = 8 }
[[method]]
name = "Gaussians"
renderer = "compensated_ray_marching"
settings = { variant = "paper" }
[[method]]
name = "unknown to this scene"
renderer = "legendre_fluids"
settings = { variant = "paper" }
)");
  }
  Result choose(const std::string& options) const {
    return run("choose '" + file("experiments/scenes/one.toml") + "' --root '" + path().string() + "' " + options,
               *this);
  }
};

// All that follows "error " up to the time.
std::vector<std::string> errors_of(const std::string& text) {
  std::vector<std::string> found;
  const std::regex error(R"(: error ([^)]*\)|below noise, < [0-9.]+ %), )");
  for (std::sregex_iterator it(text.begin(), text.end(), error), end; it != end; ++it) found.push_back((*it)[1]);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

TEST_CASE("choose refuses bad options in one line", "[cli]") {
  const Project project;
  const auto refused = [&](const std::string& options, const std::string& says) {
    const Result r = project.choose(options);
    CAPTURE(options, r.err);
    CHECK(r.code == 2);
    CHECK(r.error_lines() == 1);
    CHECK_THAT(r.err, Catch::StartsWith("airlight: ") && Contains(says));
    CHECK(r.out.empty());
  };
  refused("", "expected one of --budget TIME and --error PERCENT");
  refused("--budget 16ms --error 5%", "expected one of --budget TIME and --error PERCENT");
  refused("--budget 16", "--budget 16: expected a time with its unit");
  refused("--budget -1ms", "expected a time with its unit");
  refused("--budget nans", "expected a time with its unit");
  refused("--error 5", "--error 5: expected a share above 0 with its sign");
  refused("--error 0%", "expected a share above 0");
  refused("--budget 16ms --moves camera,ligths",
          "found 'ligths', expected some of camera, lights, media (nearest: lights)");
  refused("--budget 16ms --orders two", "--orders two: expected all or one");
  refused("--budget 16ms --rows common", "expected one experiment, as group/name");
  refused("--budget 16ms --rows common/all_ordres", "nearest: common/all_orders");
  refused("--budget 16ms --spend 3", "--spend 3: expected a time with its unit");
  refused("--budget 16ms --film 0", "--film");
  refused("--budget 16ms --samples 3", "--samples");
  refused("--budget 16ms --override film.widht=4", "nearest: width");
  refused("--budgte 16ms", "nearest: --budget");
  const Result none = run("choose --budget 16ms", project);
  CHECK(none.code == 2);
  CHECK_THAT(none.err, Contains("SCENE is missing"));
  project.write("black.toml", "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n");
  const Result black = run("choose black.toml --budget 1s --root '" + project.path().string() + "'", project);
  CHECK(black.code == 2);
  CHECK(black.error_lines() == 1);
  CHECK_THAT(black.err, Contains("the reference is black"));
  project.write("dark.toml", "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n");
  const Result dark =
      run("choose dark.toml --budget 1s --moves camera,light --root '" + project.path().string() + "'", project);
  CHECK(dark.code == 2);
  CHECK_THAT(dark.err, Contains("the scene has no lights that could move"));
}

TEST_CASE("choose ranks, and its command lines render", "[cli]") {
  const Project project;
  for (const char* const goal : {"--budget 10s --moves camera,lights,media", "--error 100%"}) {
    const Result r = project.choose(std::string(goal) + " --film 16 --samples 64 --override film.height=30");
    CAPTURE(goal, r.out, r.err);
    REQUIRE(r.code == 0);
    CHECK_THAT(r.out, Contains("48x30 pixels") && Contains("1. ") && Contains("How sure: ") &&
                          Contains("leaves out orders of scattering above one") &&
                          Contains("legendre_fluids: variant = paper has one image") &&
                          Contains("compensated_ray_marching: medium 0 is homogeneous"));
    int lines = 0;
    const std::regex command("airlight (render [^\n]* -o )picture.exr\n");
    for (std::sregex_iterator it(r.out.begin(), r.out.end(), command), end; it != end; ++it, ++lines) {
      const std::string picture = "picture" + std::to_string(lines) + ".exr";
      const Result rendered = run((*it)[1].str() + picture, project);
      CAPTURE(it->str(), rendered.err);
      CHECK(rendered.code == 0);
      CHECK(project.has(picture));
    }
    CHECK(lines >= 3);  // one of each renderer
  }
}

TEST_CASE("choose finds the same errors with any number of threads", "[cli]") {
  const Project project;
  const std::string options = "--budget 100s --moves camera --film 16 --samples 64 --threads ";
  const Result one = project.choose(options + "1"), three = project.choose(options + "3");
  REQUIRE(one.code == 0);
  REQUIRE(three.code == 0);
  CHECK(errors_of(one.out).size() >= 3);
  CHECK(errors_of(one.out) == errors_of(three.out));
}

TEST_CASE("choose by light scattered once, and within little time", "[cli]") {
  const Project project;
  const Result once = project.choose("--budget 10s --orders one --rows common/all_orders --film 16");
  CHECK(once.code == 0);
  CHECK_THAT(once.out, Contains("quadrature of light scattered once"));
  const Result hurried = project.choose("--budget 10s --spend 1ms --film 16 --samples 4096");
  CHECK(hurried.code == 0);
  CHECK_THAT(hurried.out, Contains("no time was left") && Contains("Nothing that was tried"));
  CHECK_THAT(hurried.err, Contains("--samples 4096: "));
}

}  // namespace cli_choose_test
