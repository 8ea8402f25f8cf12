// `airlight info`, `explain`, error maps and tone curves: what the program says of files and pictures.
#include <catch2/catch.hpp>

#include "scene/film/color_image.h"
#include "scene/film/film.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace cli_info_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

TEST_CASE("info says what a file holds", "[cli]") {
  const TemporaryFolder folder;
  const std::string data = root + "/experiments/data/";
  folder.write("square.obj", "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3 4\n");
  folder.write("fog.toml", box_of_fog(8, 6));
  scene::Film film(4, 2);
  film.add("mean");
  film.set("mean", 3, 1, Rgb(0.5, 0.25, 8));
  film.metadata["renderer"] = "fogshop";
  write_exr(folder.file("film.exr"), film);
  const Result told = run(
      "info square.obj fog.toml film.exr " + data + "plume_0024.vdb " + root + "/experiments/flows/plume.toml", folder);
  CAPTURE(told.out, told.err);
  REQUIRE(told.code == 0);
  CHECK_THAT(told.out, Contains("2 triangles, 4 vertices, area 6 m^2") && Contains("from (0, 0, 0) to (2, 3, 0) m"));
  CHECK_THAT(told.out, Contains("8 x 6 pixels") && Contains("light    point") && Contains("homogeneous"));
  CHECK_THAT(told.out, Contains("4 x 2 pixels") && Contains("layer mean: values from 0 to 8, mean 0.3646") &&
                           Contains("renderer = fogshop"));
  CHECK_THAT(told.out, Contains("grid 'density' of type Tree_float_5_4_3") && Contains(" voxels of "));
  CHECK_THAT(told.out, Contains("flow in 3 dimensions"));
  for (const char* wrong : {"missing.vdb", "fog.txt", "."}) {
    const Result refused = run("info " + std::string(wrong), folder);
    CAPTURE(wrong);
    CHECK(refused.code == 2);
    CHECK(refused.error_lines() == 1);
    CHECK(refused.out.empty());
  }
}

TEST_CASE("explain lists who can and who cannot, for scenes and flows", "[cli]") {
  const TemporaryFolder folder;
  folder.write("fog.toml", box_of_fog(8, 6));
  const Result listed = run("explain fog.toml", folder);
  REQUIRE(listed.code == 0);
  CHECK_THAT(listed.out, Contains("\ncan render this scene:\n") && Contains("\ncannot render this scene:\n"));
  CHECK(std::count(listed.out.begin(), listed.out.end(), '\n') < 40);
  const Result flow = run("explain " + root + "/experiments/flows/plume.toml", folder);
  REQUIRE(flow.code == 0);
  CHECK_THAT(flow.out, Contains("can solve this flow") && Contains("stable_fluids"));
  const Result solver = run("explain " + root + "/experiments/flows/plume.toml -m stable_fluids --set n=16", folder);
  REQUIRE(solver.code == 0);
  CHECK_THAT(solver.out, Contains("n = 16; "));
  CHECK_THAT(run("explain fog.toml --set steps=4", folder).err, Contains("expected --method"));
}

TEST_CASE("--camera fit sees everything that has an end", "[cli]") {
  const TemporaryFolder folder;
  folder.write(
      "bare.toml",
      "[film]\nwidth = 40\nheight = 40\n[[light]]\ntype = 'directional'\nto_light = [0, 1, 0]\nirradiance = 3\n"
      "[[medium]]\ntype = 'homogeneous'\nsigma_t = 0.5\n"
      "region = { type = 'box', lo = [9, 2, 3], hi = [11, 4, 5] }\n");
  CHECK(run("render bare.toml -m ray_marcher -o a.exr", folder).code == 2);
  REQUIRE(run("render bare.toml -m ray_marcher -o a.exr --camera fit", folder).code == 0);
  const scene::Film film = scene::read_exr(folder.file("a.exr"));
  CHECK(film.get("transmittance", 20, 20)[0] < 0.5);
  int inside = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool fog = film.get("transmittance", x, y)[0] < 1;
      inside += fog;
      if (x == 0 || y == 0 || x == 39 || y == 39) CHECK_FALSE(fog);
    }
  CHECK(inside > 40 * 40 / 4);
  CHECK_THAT(run("render bare.toml -m ray_marcher -o a.exr --camera best", folder).err, Contains("expected fit"));
  CHECK(run("explain bare.toml --camera fit --override camera.up='[0, 1, 0]'", folder).code == 2);
  folder.write("endless.toml", "[[medium]]\ntype = 'homogeneous'\nsigma_t = 0.5\n");
  CHECK_THAT(run("explain endless.toml --camera fit", folder).err, Contains("that has an end"));
}

TEST_CASE("compare draws where two pictures differ", "[cli]") {
  const TemporaryFolder folder;
  scene::Film reference(8, 4), image(8, 4);
  reference.add("mean");
  image.add("mean");
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      reference.set("mean", x, y, Rgb::Constant(0.5));
      image.set("mean", x, y, Rgb::Constant(x < 4 ? 0.5 : 1.5));
    }
  write_exr(folder.file("a.exr"), image);
  write_exr(folder.file("b.exr"), reference);
  REQUIRE(run("compare a.exr b.exr --metric rel_l2 --map map.png --map-top 2", folder).code == 0);
  const scene::ColorImage map = scene::read_color_image(folder.file("map.png"));
  REQUIRE(map.width == 8);
  // Violet (68, 1, 84) on the left, where nothing differs, and yellow (253, 231, 37) on the right, where the error is twice the mean.
  const auto srgb = [](double v) {
    return v <= 0.0031308 ? 255 * 12.92 * v : 255 * (1.055 * std::pow(v, 1 / 2.4) - 0.055);
  };
  CHECK(srgb(map.rgb[0]) == Approx(68).margin(0.6));
  CHECK(srgb(map.rgb[2]) == Approx(84).margin(0.6));
  CHECK(srgb(map.rgb[3 * 7]) == Approx(253).margin(0.6));
  CHECK(srgb(map.rgb[3 * 7 + 2]) == Approx(37).margin(0.6));
  // One wrong column in two: the mean error over 2 x 2 pixels is half the range, (33, 144, 141).
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) image.set("mean", x, y, Rgb::Constant(x % 2 ? 0.5 : 1.5));
  write_exr(folder.file("stripes.exr"), image);
  REQUIRE(run("compare stripes.exr b.exr --metric rel_l2 --map small.png --map-top 2 --map-shrink 2", folder).code ==
          0);
  const scene::ColorImage small = scene::read_color_image(folder.file("small.png"));
  REQUIRE((small.width == 4 && small.height == 2));
  CHECK(srgb(small.rgb[0]) == Approx(33).margin(0.6));
  CHECK(srgb(small.rgb[1]) == Approx(144).margin(0.6));
  CHECK_THAT(run("compare a.exr b.exr --map map.png --map-shrink 3", folder).err,
             Contains("divides the film's size 8x4"));
  CHECK(run("compare a.exr b.exr --map-shrink 2", folder).code == 2);
  CHECK(run("compare a.exr b.exr --map-top 2", folder).code == 2);
  CHECK(run("compare a.exr b.exr --map map.png --map-top 0", folder).code == 2);
  REQUIRE(run("convert a.exr plain.png b.exr grey.png --tone agx", folder).code == 0);
  CHECK(run("convert a.exr plain.png --tone film", folder).code == 2);
  const scene::ColorImage toned = scene::read_color_image(folder.file("plain.png"));
  CHECK(toned.rgb[3 * 7] < 0.95);  // 1.5 is white without a curve
}

}  // namespace cli_info_test
