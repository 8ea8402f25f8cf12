// The stress list of section 10 of the specification on the processor, by both variants; rows by row in tests/stress/README.md.
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/compensated_ray_marching/discrete_ordinates.h"
#include "methods/compensated_ray_marching/options.h"
#include "methods/compensated_ray_marching/source_radiance.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "tests/methods/compensated_ray_marching/stress_scenes.h"

namespace stress_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
using compensated_ray_marching::CompensatedRayMarching;

namespace {

const CompensatedRayMarching method;

Given settings_of(const StressScene& s, bool paper) {
  Given given = given_of(s, paper);
  if (!paper) given.try_emplace("cells", "12");
  return given;
}

}  // namespace

TEST_CASE("compensated march, stress list: pictures of both variants", "[stress][compensated_ray_marching][slow]") {
  for (const StressScene& s : StressScenes::all())
    for (const bool paper : {false, true}) {
      if (!(paper ? s.for_paper : s.for_grid)) continue;
      CAPTURE(s.row, s.what, s.sigma, paper);
      const scene::Film film = picture(method, s.scene, settings_of(s, paper));
      check_stress(s, film, paper);
      if (s.row == 1) {
        auto clear = std::make_shared<scene::Scene>(*s.scene);
        clear->media.clear();
        finish(*clear);
        CHECK(picture(method, clear, settings_of(s, paper)).layer("mean") == film.layer("mean"));
      }
    }
}

TEST_CASE("compensated march, stress list: voxels' transmittances are those of their columns",
          "[stress][compensated_ray_marching]") {
  for (const StressScene& s : StressScenes::all()) {
    if (s.row != 12 && s.row != 13 && s.row != 18) continue;
    if (s.given.count("residual")) continue;
    const scene::Film film = picture(method, s.scene, {{"cells", "4"}, {"slices", "1024"}, {"multiple", "none"}});
    // If the density is constant, equal slices have no error. Otherwise the error is that of midpoints
    // at the kinks between voxels.
    const bool even = s.what.starts_with("1 x 1 x 1, clamped") || s.row == 18;
    double worst = 0;
    int crossed = 0;
    for (int y = 0; y < film.height; ++y)
      for (int x = 0; x < film.width; ++x) {
        const Ray ray = camera_ray(s.scene->camera, x + 0.5, y + 0.5, film.width, film.height);
        const double depth = 4 * density_integral(s.scene->media[0], ray, {0, infinity});
        worst = std::max(worst, std::abs(film.get("transmittance", x, y)[0] - std::exp(-depth)));
        crossed += depth > 0.01;
      }
    CAPTURE(s.row, s.what, worst);
    CHECK(crossed > 3);
    // The error of fitted smoke includes half a level of its residual.
    CHECK(worst < (even ? 1e-6 : 2e-4) + (s.what.ends_with("fitted") ? 1e-3 : 0));
  }
}

TEST_CASE("compensated march, stress list: albedo 1 is refused where the system is singular",
          "[stress][compensated_ray_marching]") {
  int seen = 0;
  for (const StressScene& s : StressScenes::all()) {
    if (s.row != 5) continue;
    const auto reasons = [&](const Given& given) { return method.supports(*s.scene, {method.settings(), given}); };
    for (const char* multiple : {"auto", "as_printed", "corrected"}) {
      REQUIRE(reasons({{"variant", "paper"}, {"multiple", multiple}}).size() == 1);
      CHECK_THAT(reasons({{"variant", "paper"}, {"multiple", multiple}}).front(), Contains("albedo 1"));
    }
    CHECK(reasons({{"variant", "paper"}, {"multiple", "none"}}).empty());
    CHECK(reasons({}).empty());
    ++seen;
  }
  CHECK(seen == 6);
}

TEST_CASE("compensated march, stress list: thin ordinates are done in two iterations",
          "[stress][compensated_ray_marching]") {
  using namespace compensated_ray_marching;
  const OrdinateGrid grid{{8, 8, 8}, Vec3::Constant(0.1)};
  for (const double albedo : {0.5, 1.0}) {
    Moments source = Moments::Zero(grid.nodes(), 16);
    source.col(0).setConstant(1);
    const DiscreteOrdinates solver(grid, Eigen::ArrayXd::Constant(grid.nodes(), 1e-6), albedo, {1, 0.5, 0.25, 0.125},
                                   {});
    CHECK(solver.solve(source).iterations <= 2);
    CHECK(solver.solve(source, 1).iterations <= 2);
  }
}

TEST_CASE("compensated march, stress list: narrow phase functions keep the light's mean, and are warned of",
          "[stress][compensated_ray_marching]") {
  using namespace compensated_ray_marching;
  for (const double g : {-0.99, 0.99}) {
    std::vector<Rgb> light;
    for (int i = 0; i < 16; ++i) light.push_back(Rgb(1 + i, 2, 0.1 * i));
    const Rgb mean = light[0];
    CHECK((scattered(light, Rgb::Constant(0.9), phase_moments(scene::HenyeyGreenstein{g}, 4))[0] - 0.9 * mean)
              .abs()
              .maxCoeff() < 1e-15);
  }
  const auto scene = std::make_shared<scene::Scene>(*StressScenes::all().at(2).scene);
  const auto doubt = [&](const scene::PhaseFunction& phase, const Given& given, bool again = true) {
    scene->media[0].phase = phase;
    return doubt_of(*scene, read_options({method.settings(), given}), again);
  };
  using HG = scene::HenyeyGreenstein;
  for (const Given& given : {Given{}, Given{{"variant", "paper"}}})
    for (const double sign : {-1.0, 1.0}) {
      CHECK(doubt(HG{0.6 * sign}, given).empty());
      CHECK_THAT(doubt(HG{0.601 * sign}, given), Contains("0.13 down with order = 4"));
    }
  CHECK(doubt(scene::Isotropic{}, {{"order", "1"}}).empty());
  CHECK(doubt(scene::Rayleigh{}, {}).empty());
  CHECK_THAT(doubt(scene::Murky{}, {}), Contains("order = 4"));
  CHECK_THAT(doubt(HG{0.4}, {{"order", "2"}}), Contains("order = 2"));
  CHECK(doubt(HG{0.7}, {{"order", "6"}}).empty());
  // Without multiple scattering, what light has bands for.
  CHECK(doubt(HG{0.7}, {}, false).empty());
  CHECK_THAT(doubt(HG{0.8}, {}, false), Contains("single scattering of environments") && Contains("levels = 8"));
  CHECK(doubt(HG{0.8}, {{"levels", "16"}}, false).empty());
  scene->lights = {scene::DirectionalLight{}};
  CHECK(doubt(HG{0.99}, {}, false).empty());
  scene->media[0].albedo = Rgb::Zero();
  CHECK(doubt(HG{0.99}, {}).empty());
}

// Row 28: what counts as no density is small beside the rest, not beside 1.
TEST_CASE("compensated march, stress list: densities are seen beside extinction alone",
          "[stress][compensated_ray_marching]") {
  const StressScene& s = StressScenes::all().at(2);
  for (const double scale : {1e-20, 1e20}) {
    auto other = std::make_shared<scene::Scene>(*s.scene);
    for (scene::Gaussian& g : std::get<scene::GaussianSum>(other->media[0].field).gaussians) g.amplitude *= scale;
    other->media[0].sigma_t /= scale;
    finish(*other);
    for (const bool paper : {false, true})
      CHECK(relative_l2(picture(method, other, settings_of(s, paper)), picture(method, s.scene, settings_of(s, paper)),
                        "mean") < 1e-6);
  }
}

// Row 10: an empty frame hands on the solution of the one before, and what comes after it is drawn as if nothing had been.
TEST_CASE("compensated march, stress list: an empty frame in between", "[stress][compensated_ray_marching]") {
  const std::vector<StressScene>& all = StressScenes::all();
  const auto first_of = [&](int row) {
    return std::find_if(all.begin(), all.end(), [&](const StressScene& s) { return s.row == row; })->scene;
  };
  const auto empty = first_of(1), smoke = first_of(27);
  for (const Given& given : {Given{{"cells", "12"}}, Given{{"variant", "paper"}}}) {
    const auto prepared = method.prepare(smoke, {method.settings(), given}, {1, {}});
    CHECK(next_frame(*prepared, empty).film.layer("mean") == picture(method, empty, given).layer("mean"));
    if (!given.count("variant"))  // the other is not solved to its end
      CHECK(relative_l2(next_frame(*prepared, smoke).film, picture(method, smoke, given)) < 3e-4);
    const auto nothing = method.prepare(empty, {method.settings(), given}, {1, {}});
    CHECK_FALSE(nothing->next(smoke, {1, {}}));
    CHECK(nothing->next(empty, {1, {}}));
    CHECK(nothing->render(view_of(*empty), {1, {}}).film.layer("mean") == picture(method, empty, given).layer("mean"));
  }
}

}  // namespace stress_test
