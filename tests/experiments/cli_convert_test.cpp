// `airlight convert` of media: what it prints is a medium that loads.
#include <catch2/catch.hpp>

#include "scene/film/film.h"
#include "scene/film/grey_image.h"
#include "scene/math/legendre.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"
#include "tests/experiments/run_program.h"

namespace cli_convert_test {

using namespace airlight;
using namespace airlight::test;

namespace {

const std::string camera = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";

const scene::LegendreBox& box_of(const scene::Scene& scene) {
  return *std::get<scene::LegendrePointer>(scene.media.at(0).field);
}

}  // namespace

TEST_CASE("a voxel grid and a medium of a scene become Legendre boxes", "[cli][legendre]") {
  const TemporaryFolder folder;
  const Result grid =
      run("convert " + root + "/experiments/data/plume_0024.vdb plume.csv --coefficients 5,7,4 --cells 8", folder);
  CAPTURE(grid.out, grid.err);
  REQUIRE(grid.code == 0);
  const scene::Scene plume = scene::parse_scene(camera + grid.out, "s.toml", folder.path().string());
  CHECK(box_of(plume).shape() == scene::TensorShape{5, 7, 4});
  CHECK_FALSE(box_of(plume).negative());

  const std::string gaussians = scenes + "elephant_gaussians.toml";
  const Result refused = run("convert " + gaussians + " fog.csv", folder);
  CHECK(refused.code == 2);
  CHECK_THAT(refused.err, Catch::Contains("no end"));

  folder.write("ball.toml", camera +
                                "[[medium]]\ntype = 'homogeneous'\n[[medium]]\nname = 'ball'\ntype = 'homogeneous'\n"
                                "region = { type = 'sphere', center = [0, 0, 0], radius = 1 }\n");
  for (const char* const choice : {"ball", "1"}) {
    const Result ball = run(
        "convert ball.toml ball.csv --cells 8 --coefficients 8 --no-limiter --medium " + std::string(choice), folder);
    REQUIRE(ball.code == 0);
    const scene::Scene read = scene::parse_scene(camera + ball.out, "s.toml", folder.path().string());
    CHECK(box_of(read).shape() == scene::TensorShape{8, 8, 8});
    CHECK(box_of(read).negative());
    // The mean is 4 pi / 3 over 8; eight cells of four points a side meet the ball to a per cent.
    CHECK(box_of(read).coefficients()[0] == Approx(std::sqrt(8.0) * pi / 6).epsilon(0.01));
  }
  CHECK(run("convert ball.toml ball.csv --medium nobody", folder).code == 2);
  CHECK(run("convert ball.toml ball.csv --medium 2", folder).code == 2);
  CHECK(run("convert ball.toml ball.csv --medium 1 --coefficients 3,3", folder).code == 2);
  CHECK(run("convert ball.toml ball.csv --medium 1 --coefficients 33", folder).code == 2);
  CHECK_THAT(run("convert ball.toml ball.exr --medium 1", folder).err, Catch::Contains("expected a name in .csv"));
}

TEST_CASE("a depth scale is a length", "[cli]") {
  const TemporaryFolder folder;
  scene::Film film;
  film.width = film.height = 2;
  film.add("mean");
  for (int i = 0; i < 4; ++i) film.set("mean", i % 2, i / 2, Rgb::Constant(i));
  scene::write_exr(folder.file("a.exr"), film);
  for (const std::string scale : {"-1", "0", "nan", "inf", "-inf"}) {
    const Result refused = run("convert a.exr a.png --depth-scale " + scale, folder);
    CAPTURE(scale, refused.err);
    CHECK(refused.code == 2);
    CHECK(refused.err == "airlight: --depth-scale " + scale + ": expected metres above 0\n");
    CHECK_FALSE(std::filesystem::exists(folder.file("a.png")));
  }
  REQUIRE(run("convert a.exr a.png --depth-scale 4", folder).code == 0);
  CHECK(scene::read_grey_image(folder.file("a.png"), "", 10).values[3] == Approx(0.75).epsilon(1e-4));
}

TEST_CASE("endings may be in capitals", "[cli]") {
  const TemporaryFolder folder;
  std::filesystem::copy_file(root + "/experiments/data/plume_0024.vdb", folder.path() / "U.VDB");
  folder.write("U.TOML", "[film]\nwidth = 8\nheight = 6\n" + camera +
                             "[[medium]]\ntype = 'grid'\nsize = [2, 2, 2]\nvoxel_size = 0.1\norigin = [0, 0, 0]\n"
                             "values = [1, 1, 1, 1, 1, 1, 1, 1]\n");
  const auto good = [&](const std::string& arguments) {
    const Result result = run(arguments, folder);
    CAPTURE(arguments, result.err);
    CHECK(result.code == 0);
  };
  good("render U.TOML -m ray_marcher -o V.EXR --png V.PNG");
  good("convert V.EXR W.PNG");
  good("convert V.EXR W.PFM");
  good("convert U.VDB L.CSV --coefficients 2 --cells 2");
  good("convert U.VDB M.EXR --pixels 4 --samples 1");
  good("fit U.TOML -n 2 --out fitted");
  // The converted files are used as a fogmap, and as picture and depth behind the media.
  folder.write("map.toml", camera +
                               "[[medium]]\ntype = 'fogmap'\nfile = 'M.EXR'\nchannel = 'Y'\ncell = 1\nsigma_t = 1\n"
                               "region = { type = 'slab', lo = 0, hi = 1 }\n");
  good("explain map.toml -m ray_marcher");
  folder.write("back.toml",
               "[film]\nwidth = 8\nheight = 6\n" + camera + "[backdrop]\nimage = 'V.PNG'\ndepth = 'W.PNG'\nfar = 10\n");
  const Result back = run("explain back.toml -m ray_marcher", folder);
  CHECK_THAT(back.err, !Catch::Contains("expected a name in"));
}

}  // namespace cli_convert_test
