// Errors of a picture where no sample, or next to none, brought light.
#include "reference/path_tracer/certainty.h"

#include <catch2/catch.hpp>

#include "reference/deterministic/renderer.h"
#include "reference/path_tracer/accumulation.h"
#include "reference/path_tracer/unsupported.h"
#include "tests/reference/path_tracer/scenes.h"

namespace certainty_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

scene::Film picture(const std::shared_ptr<scene::Scene>& scene, std::uint64_t samples, bool forced = false) {
  scene::View view;
  view.camera = scene::look_at(Point3(0, 0, 4), Point3::Zero(), Vec3::UnitY());
  view.camera.vertical_fov = 0.9;
  view.width = view.height = 8;
  Options options;
  options.samples = samples;
  options.forced = forced;
  const World world(scene, options);
  Accumulation samples_of = empty_accumulation(world, view);
  render_range(world, view, 0, samples, {}, samples_of);
  return to_film(world, view, samples_of);
}

const Box left{{-1, -1, -1}, {0, 1, 1}}, right{{0, -1, -1}, {1, 1, 1}};

}  // namespace

TEST_CASE("a standard error of few contributions is an upper end", "[path_tracer]") {
  // 100 samples; the greatest of the picture is 5: 3 / 100 * 5.
  CHECK(honest_error(0, 0, 100, 5, true) == Approx(0.15));
  CHECK(honest_error(0, 0, 100, 5, false) == 0);
  // One contribution of 2: mean 0.02, its own estimate sqrt((4 - 4 / 100) / (100 * 99)) = 0.02.
  CHECK(honest_error(2, 4, 100, 5, true) == Approx(0.15));
  // With a lesser greatest one the estimate stands, and so it does for 50 of 0.1 each: sqrt((0.5 - 0.25) / 9900).
  CHECK(honest_error(2, 4, 100, 0.5, true) == Approx(std::sqrt(3.96 / 9900)));
  CHECK(honest_error(5, 0.5, 100, 5, true) == Approx(std::sqrt(0.25 / 9900)));
  // All alike: no noise, whatever their number; a single sample says nothing about its error.
  CHECK(honest_error(6, 18, 2, 5, true) == 0);
  CHECK(honest_error(3, 9, 1, 5, true) == Approx(15));
  // Squares that underflow.
  CHECK(honest_error(1e-200, 0, 100, 5e-200, true) == Approx(0.15e-200));
}

// A thin medium beside a thick one, analog paths: before, pixels of the thin one had 0 with a standard error of 0.
TEST_CASE("pixels that no light was found for do not claim certainty", "[path_tracer]") {
  const scene::Light sun = scene::DirectionalLight{Vec3(0.6, 0.64, 0.48), Rgb(3, 2, 0)};
  const auto film = picture(scene_of({medium(left, 1e-7, 1), medium(right, 1, 1)}, {sun}), 64);
  const Rgb thin = film.get("mean", 3, 4), error = film.get("se", 3, 4);
  float greatest = 0;
  for (std::size_t i = 0; i < film.pixels(); ++i) greatest = std::max(greatest, film.layer("max_sample")[3 * i]);
  CHECK(thin[0] == 0);
  CHECK(error[0] == Approx(3. / 64 * greatest));
  CHECK(error[1] > 0);
  CHECK(error[2] == 0);                 // no light in that channel
  CHECK(film.get("se", 0, 0)[0] == 0);  // the ray meets nothing
  CHECK(film.metadata.count("warning") == 0);
}

TEST_CASE("a picture without any light says whether there can be none", "[path_tracer]") {
  const scene::Light sun = scene::DirectionalLight{};
  const auto thin = picture(scene_of({medium(left, 1e-9, 1)}, {sun}), 64);
  CHECK(thin.metadata.at("unresolved").starts_with("mean order.1"));
  CHECK_THAT(thin.metadata.at("warning"), Catch::Contains("none of 64 samples per pixel brought light"));
  for (const auto& dark :
       {scene_of({medium(left, 1e-9, 0)}, {sun}), scene_of({medium(left, 1e-9, 1)}, {}), scene_of({}, {sun})}) {
    const auto film = picture(dark, 64);
    CHECK(film.metadata.count("warning") == 0);
    CHECK(film.metadata.count("unresolved") == 0);
    for (const float error : film.layer("se")) CHECK(error == 0);
  }
  // Forced, the thin medium is no problem.
  CHECK(picture(scene_of({medium(left, 1e-9, 1)}, {sun}), 64, true).metadata.count("warning") == 0);
}

// Samples of a thin and narrow medium are all alike but for those that miss. Where up to 3 % missed, one picture in six
// saw none of them in a pixel's 64 samples, and claimed 3 % too much with next to no error: 8 % of all pixels were more
// than 6 standard errors off, up to 1e5.
TEST_CASE("a narrow thin medium is no more certain than it should be", "[path_tracer]") {
  const std::vector<scene::Light> lights[] = {{scene::DirectionalLight{Vec3(0.6, 0.64, 0.48), Rgb::Ones()}},
                                              {scene::PointLight{Point3(1.5, 2, 0.5), Rgb::Ones(), 0}}};
  for (const auto& light : lights)
    for (const double width : {1e-2, 1e-5})
      for (const double depth : {1e-4, 1e-2}) {
        scene::Medium cloud = medium(scene::Unbounded{}, 1, 0.9);
        scene::GaussianSum sum;
        sum.gaussians = {{Point3::Zero(), width, depth / (std::sqrt(pi) * width)}};
        cloud.field = sum;
        const auto scene = scene_of({cloud}, light);
        scene::View view;
        view.camera = scene::look_at(Point3(0.1, 0.3, 4), Point3::Zero(), Vec3::UnitY());
        view.camera.vertical_fov = 1.5 * width;
        view.width = view.height = 7;
        scene->camera = view.camera;
        const scene::Film truth = deterministic::make_renderer()
                                      ->prepare(scene, {deterministic::make_renderer()->settings(), {}}, {1, {}})
                                      ->render(view, {1, {}})
                                      .film;
        for (std::uint32_t seed = 1; seed <= 20; ++seed) {
          Options options;
          options.samples = 64;
          options.max_order = 1;
          options.seed = seed;
          const World world(scene, options);
          Accumulation samples = empty_accumulation(world, view);
          render_range(world, view, 0, 64, {1, {}}, samples);
          const scene::Film film = to_film(world, view, samples);
          int far = 0;
          for (int y = 0; y < 7; ++y)
            for (int x = 0; x < 7; ++x) {
              const double expected = truth.get("airlight", x, y)[0], found = film.get("mean", x, y)[0];
              far += std::abs(found - expected) > 6 * film.get("se", x, y)[0] + 1e-6 * expected;
            }
          CAPTURE(width, depth, seed);
          // None of all 7840 estimates is that far off. (The normal distribution's 2e-9 does not apply to 64 samples.)
          CHECK(far == 0);
        }
      }
}

// Intensity 1e308 over a distance of 1e-3 leaves the range of double.
TEST_CASE("a radiance that is not finite names scene, pixel, sample and layer", "[path_tracer]") {
  auto bright = scene_of({medium(left, 1, 1)}, {scene::PointLight{Point3(-0.2, 0, 1.001), Rgb::Constant(1e308), 0}});
  bright->name = "too bright";
  CHECK_THROWS_WITH(picture(bright, 64), Catch::StartsWith("path_tracer: scene 'too bright', pixel (") &&
                                             Catch::Contains(": layer ") && !Catch::Contains("\n"));
}

// In double, but not in the single precision of a film.
TEST_CASE("a picture beyond the range of its film names scene, pixel and layer", "[path_tracer]") {
  auto bright = scene_of({medium(left, 1, 1)}, {scene::DirectionalLight{Vec3::UnitY(), Rgb::Constant(1e60)}});
  bright->name = "too bright";
  CHECK_THROWS_WITH(picture(bright, 64), Catch::StartsWith("path_tracer: scene 'too bright': layer '") &&
                                             Catch::Contains("expected a finite 32-bit number"));
}

TEST_CASE("work without end is refused in one line", "[path_tracer]") {
  scene::GaussianSum sum;
  sum.gaussians.assign(20000, {Point3::Zero(), 1, 1e-5});
  scene::Medium cloud = medium(left, 1, 0.9);
  cloud.field = sum;
  Options options;
  options.samples = 1 << 20;
  const auto scene = scene_of({cloud}, {scene::DirectionalLight{}});
  scene->width = 160;
  scene->height = 120;
  REQUIRE(unsupported(*scene, options).size() == 1);
  CHECK_THAT(unsupported(*scene, options).front(), Catch::Contains("160 x 120 pixels, 1048576 samples"));
  options.samples = 256;
  CHECK(unsupported(*scene, options).empty());
  // A supergrid that no memory holds, and one that takes days to fill.
  options.supergrid_cells = 1024;
  REQUIRE(unsupported(*scene, options).size() == 1);
  CHECK(unsupported(*scene, options).front() ==
        "supergrid_cells = 1024 takes 4.3 GB of majorants for 1 media, expected at most 1.1: fewer supergrid_cells");
  options.supergrid_cells = 400;
  CHECK(unsupported(*scene, options).empty());
  std::get<scene::GaussianSum>(scene->media[0].field).gaussians.resize(1 << 20, sum.gaussians[0]);
  options.samples = 1;
  scene->width = scene->height = 16;
  options.supergrid_cells = 512;
  REQUIRE(unsupported(*scene, options).size() == 1);
  CHECK_THAT(unsupported(*scene, options).front(),
             Catch::Contains("supergrid_cells = 512: majorants of 1e+08 cells need 1e+14 evaluations"));
  options.supergrid_cells = 0;
  CHECK(unsupported(*scene, options).empty());
  options.samples = 256;
  // Endless fog that scatters everything: no end of collisions, unless paths end after one.
  const auto endless = scene_of({medium(scene::Unbounded{}, 1, 1)}, {scene::DirectionalLight{}});
  REQUIRE(unsupported(*endless, options).size() == 1);
  CHECK_THAT(unsupported(*endless, options).front(),
             Catch::StartsWith("medium 0 scatters everything"));  // it has no name
  options.paths = Options::Paths::scattered_to_surface;
  CHECK(unsupported(*endless, options).empty());
}

}  // namespace certainty_test
