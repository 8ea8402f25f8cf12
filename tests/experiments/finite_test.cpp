// A value that is not finite ends whatever would keep it, with pixel and layer, before anything is written.
#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>

#include "experiments/driver/run.h"
#include "scene/base/error.h"
#include "scene/film/film.h"
#include "tests/experiments/run_program.h"

namespace finite_test {

using namespace airlight;
using airlight::test::Result;
using airlight::test::run;
using Catch::Contains;

namespace {

// 1e30 W/sr a micrometre above a plane: 1e42 W/m^2, more than a 32-bit float holds, in the middle pixel.
const std::string too_bright =
    "film = { width = 3, height = 3 }\n[camera]\nposition = [0, 1, 1]\nlook_at = [0, 0, 0]\n"
    "[[light]]\ntype = 'point'\nposition = [0, 1e-6, 0]\nintensity = 1e30\n"
    "[[surface]]\ntype = 'plane'\npoint = [0, 0, 0]\n";

}  // namespace

TEST_CASE("a film that is not finite names layer, pixel and channel", "[film]") {
  scene::Film film(5, 4);
  film.add("mean");
  film.add("surface");
  CHECK_NOTHROW(require_finite(film, "a.exr"));
  film.metadata["renderer"] = "fogshop";
  for (const float bad : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()}) {
    scene::Film other = film;
    other.layers["surface"][3 * (2 * 5 + 3) + 1] = bad;
    CHECK_THROWS_WITH(require_finite(other, "a.exr"),
                      Contains("a.exr: layer 'surface', pixel (3, 2), G: found ") && Contains("from fogshop"));
    const TemporaryFolder folder;
    CHECK_THROWS_AS(write_exr(folder.file("a.exr"), other), Error);
    CHECK(std::filesystem::is_empty(folder.path()));
  }
}

TEST_CASE("the command line writes no picture that is not finite", "[cli]") {
  for (const char* const method :
       {"deterministic", "ray_marcher", "shadow_planes", "fogshop", "path_tracer --samples 64"}) {
    CAPTURE(method);
    const TemporaryFolder folder;
    folder.write("s.toml", too_bright);
    const Result r = run(std::string("render s.toml -o a.exr --png a.png -m ") + method, folder);
    CHECK(r.code == 2);
    CHECK(r.error_lines() == 1);
    CHECK_THAT(r.err, (Contains("a.exr: layer '") || Contains("scene 's': layer '")) && Contains("pixel (1, 1)") &&
                          Contains("expected a finite"));
    CHECK_FALSE(std::filesystem::exists(folder.path() / "a.exr"));
    CHECK_FALSE(std::filesystem::exists(folder.path() / "a.png"));
  }
}

TEST_CASE("an experiment keeps no row and no reference that is not finite", "[driver]") {
  using namespace airlight::experiments;
  for (const char* const renderer : {"deterministic", "path_tracer"})
    for (const bool reference : {false, true}) {
      CAPTURE(renderer, reference);
      const TemporaryFolder folder;
      folder.write("experiments/README.md", "");
      folder.write("experiments/scenes/one.toml", too_bright);
      const std::string name = std::string("'") + renderer + "'\n";
      folder.write("experiments/g/e.toml",
                   std::string("title = 'e'\nlayer = 'surface'\n") + (reference ? "metrics = ['rel_l2']\n" : "") +
                       "[[scene]]\nfile = 'scenes/one.toml'\n" +
                       (reference ? "[reference]\nrenderer = " + name + "[[method]]\nrenderer = 'ray_marcher'\n"
                                  : "[[method]]\nrenderer = " + name));
      const auto experiment = read_experiment(folder.path(), "g/e", "full");
      CHECK_THROWS_WITH(
          run_experiment(experiment, {folder.path(), false, 1, false}),
          Contains("g/e: one: ") && Contains(renderer) && Contains("layer '") && Contains("pixel (1, 1)"));
      CHECK_FALSE(std::filesystem::exists(folder.path() / "results"));
    }
}

}  // namespace finite_test
