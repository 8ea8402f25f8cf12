// The renderer: closed forms, extremes (section 10 of the specification), what it refuses.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "scene/convert/residual.h"
#include "scene/geometry/shapes.h"
#include "scene/media/fitted.h"
#include "tests/methods/compensated_ray_marching/puffs.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"
#include "tests/oracle_vectors.h"
#include "tests/pictures.h"

namespace renderer_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
using compensated_ray_marching::CompensatedRayMarching;

namespace {

const CompensatedRayMarching method;
const Given paper{{"variant", "paper"}};

}  // namespace

TEST_CASE("compensated march: what scatters everything is not seen in an even light", "[compensated_ray_marching]") {
  const auto error = [](double sigma_t, int cells) {
    const scene::Film film = picture(method, in_white(puffs(), sigma_t, 1), {{"cells", std::to_string(cells)}}, 0);
    double most = 0;
    for (const float v : film.layer("mean")) most = std::max(most, std::abs(v - 1.0));
    return most;
  };
  // Thin and half deep smoke: cells' means alone, of second order in the cell.
  for (const double sigma_t : {0.1, 2.0}) {
    const double coarse = error(sigma_t, 12), fine = error(sigma_t, 32);
    CAPTURE(sigma_t, coarse, fine);
    CHECK(fine < 0.012);
    CHECK(fine < 0.7 * coarse);
  }
  // Deep smoke, whose 12 cells become 20 lest they be too deep: the middle is dark by what the sweeps smear across
  // boundary layers of 1 / (8 m^-1), thinner than a cell; of first order at best, as in the ball of the ordinates' own tests.
  const double coarse = error(8, 12), fine = error(8, 64);
  CAPTURE(coarse, fine);
  CHECK(coarse < 0.02);
  CHECK(fine < 0.7 * coarse);
}

TEST_CASE("compensated march: rays out of a ball of smoke under an even sky",
          "[compensated_ray_marching][slow][thorough]") {
  for (const json& v : vectors_of("compensated_ray_marching", "multiple_scattering_sphere")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    const json& rbf = in.at("rbf_x_y_z_r_w").at(0);
    const double r = number(rbf[3]);
    const Point3 centre = vec(rbf);
    auto s = std::make_shared<scene::Scene>();
    scene::Medium smoke;
    smoke.field = scene::GaussianSum{{{centre, r, number(rbf[4])}}, 0, number(in.at("cut"))};
    smoke.sigma_t = Rgb::Constant(number(in.at("sigma_t")));
    smoke.albedo = Rgb::Constant(number(in.at("albedo")));
    smoke.phase = scene::HenyeyGreenstein{number(in.at("g"))};
    s->media = {smoke};
    s->lights = {scene::make_constant_environment(Rgb::Ones())};
    s->width = s->height = 1;
    finish(*s);
    std::vector<double> errors;
    for (const int cells : {3, 8}) {  // a radius; directions with them. At 4 and g = 0 errors cancel: 0.0007
      const Given given{{"cells", std::to_string(6 * cells + 1)},
                        {"levels", std::to_string(2 * cells)},
                        {"ordinate_levels", std::to_string((cells + 1) / 2)},
                        {"azimuths", std::to_string(2 * cells)},
                        {"slices", "1024"},
                        {"deepest_cell", "9"}};
      const auto prepared = method.prepare(s, {method.settings(), given}, {0, {}});
      double error = 0, size = 0;
      for (std::size_t k = 0; k < in.at("impact_over_r").size(); ++k) {
        const Point3 eye = centre + Vec3(number(in.at("impact_over_r")[k]) * r, 0, 1);
        const scene::Film film =
            prepared->render({scene::look_at(eye, eye - Vec3::UnitZ(), Vec3::UnitY()), 1, 1}, {1, {}}).film;
        const double radiance = number(expected.at("exit_radiance")[k]),
                     left = number(expected.at("exit_transmittance")[k]);
        CHECK(std::abs(film.get("transmittance", 0, 0)[0] - left) <= 1e-4 * left);
        error += std::pow(film.get("mean", 0, 0)[0] - radiance, 2);
        size += radiance * radiance;
      }
      errors.push_back(std::sqrt(error / size));
    }
    CAPTURE(v.at("id").get<std::string>(), errors[0], errors[1]);
    CHECK(errors[1] < (number(in.at("albedo")) < 0.95 ? 0.002 : 0.004));
    CHECK(errors[1] < 0.4 * errors[0]);
  }
}

TEST_CASE("compensated march: albedo 0, no light, thin and black smoke", "[compensated_ray_marching]") {
  for (const Given& given : {Given{}, paper}) {
    CAPTURE(given);
    const scene::Film black = picture(method, in_white(puffs(), 2, 0), given);
    CHECK(relative_l2(black.layer("mean"), black.layer("transmittance")) < 1e-6);
    for (const float v : black.layer("airlight")) REQUIRE(v == 0);
    const scene::Film dark =
        picture(method, scene_of(puffs(), 2, 0.9, scene::make_constant_environment(Rgb::Zero())), given);
    for (const float v : dark.layer("mean")) REQUIRE(v == 0);
    const scene::Film thin = picture(method, in_white(puffs(), 1e-6), given);
    for (const float v : thin.layer("mean")) REQUIRE(std::abs(v - 1) < 1e-5);
    Given any_depth = given;
    if (given.empty()) any_depth["deepest_cell"] = "1e9";
    const scene::Film thick = picture(method, in_white(puffs(), 1e4), any_depth);
    CHECK(all_finite(thick));
    const std::size_t middle = 3 * (4 * 12 + 6);
    CHECK(thick.layer("transmittance")[middle] == 0);
    for (const float v : thick.layer("mean")) REQUIRE((v >= 0 && v < (given.empty() ? 1.5 : 1e3)));
  }
}

TEST_CASE("compensated march: paper leaves out what is less than the tolerance, and a residual of nothing",
          "[compensated_ray_marching]") {
  const auto stage = [](const std::shared_ptr<scene::Scene>& scene, const char* name) {
    for (const scene::Stage& s : method.prepare(scene, {method.settings(), paper}, {1, {}})->stages())
      if (s.name == name) return s;
    FAIL("no stage " << name);
    return scene::Stage{};
  };
  // Columns along the axes of puffs(): sqrt(pi) (0.4 + 0.25 0.7 + 0.3 0.9) = 1.498; 2e-4 is the tolerance.
  const auto kept = [&](double sigma_t, double albedo) {
    const auto scene = in_white(puffs(), sigma_t, albedo);
    const scene::Stage s = stage(scene, "multiple scattering");
    CHECK((render(method, scene, paper).counters.at("iterations") > 0) == s.kept);
    CHECK_THAT(s.reason, Contains(s.kept ? "iterations, residual" : "of the light is scattered again"));
    return s.kept;
  };
  CHECK_FALSE(kept(1e-6, 0.8));
  CHECK_FALSE(kept(1.6e-4, 0.8));
  CHECK(kept(1.8e-4, 0.8));
  CHECK_FALSE(kept(30, 1.9e-4));
  CHECK(kept(30, 2.1e-4));

  scene::VoxelGrid grid;
  grid.size = {8, 8, 8};
  grid.voxel_size = 0.2;
  grid.translation = Vec3::Constant(-0.7);
  auto fitted = std::make_shared<scene::Fitted>();
  fitted->gaussians = puffs();
  grid.values = scene::decoded(grid, puffs(), {}).values;
  scene::QuantisationOptions one;
  one.step = 1;
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(grid, puffs(), one));
  fitted->grid = scene::decoded(puffs(), *fitted->residual);
  const auto of_fit = in_white(puffs(), 2);
  of_fit->media[0].field = scene::FittedPointer(fitted);
  finish(*of_fit);
  CHECK_FALSE(stage(of_fit, "residual").kept);
  const Given alone{{"variant", "paper"}, {"residual", "false"}};
  CHECK(picture(method, of_fit, paper).layer("mean") == picture(method, of_fit, alone).layer("mean"));
  for (float& v : grid.values) v += 2;
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(grid, puffs(), one));
  fitted->grid = scene::decoded(puffs(), *fitted->residual);
  finish(*of_fit);
  CHECK(stage(of_fit, "residual").kept);
}

TEST_CASE("compensated march: no Gaussian, one, two at one place, one without weight, the eye within",
          "[compensated_ray_marching]") {
  scene::GaussianSum none, empty, one, twins, idle = puffs();
  none.cutoff = empty.cutoff = one.cutoff = twins.cutoff = 3;
  empty.gaussians = {{{0, 0, 0}, 0.5, 0}};
  one.gaussians = {{{0, 0, 0}, 0.5, 1}};
  twins.gaussians = {{{0, 0, 0}, 0.5, 0.5}, {{0, 0, 0}, 0.5, 0.5}};
  idle.gaussians.push_back({{0, 0, 0}, 0.5, 0});
  idle.gaussians.push_back({{30, 0, 0}, 0.1, 0});  // where there is nothing at all
  for (const Given& given : {Given{}, paper}) {
    CAPTURE(given);
    for (const scene::GaussianSum& nothing : {none, empty}) {
      const scene::Film clear = picture(method, in_white(nothing, 2), given);
      for (const float v : clear.layer("mean")) REQUIRE(v == 1);
    }
    const scene::Film single = picture(method, in_white(one, 2), given),
                      both = picture(method, in_white(twins, 2), given);
    CHECK(all_finite(single));
    CHECK(relative_l2(both, single, "mean") < (given.empty() ? 1e-6 : 1e-3));
    CHECK(relative_l2(picture(method, in_white(idle, 2), given), picture(method, in_white(puffs(), 2), given), "mean") <
          1e-6);
    auto inside = in_white(puffs(), 2);
    inside->camera = scene::look_at({0.05, 0.1, 0}, {1, 0.1, 0}, Vec3::UnitY());
    finish(*inside);
    CHECK(all_finite(picture(method, inside, given)));
  }
}

TEST_CASE("compensated march: phase functions at their ends stay finite and not below 0",
          "[compensated_ray_marching]") {
  for (const double g : {-0.99, 0.99})
    for (const Given& given : {Given{}, paper}) {
      auto scene = scene_of(puffs(), 2, 0.9, uneven());
      scene->media[0].phase = scene::HenyeyGreenstein{g};
      finish(*scene);
      const scene::Film film = picture(method, scene, given);
      CAPTURE(g, given);
      CHECK(all_finite(film));
      for (const float v : film.layer("airlight")) REQUIRE(v >= 0);
    }
}

TEST_CASE("compensated march: the same bits for any number of threads", "[compensated_ray_marching]") {
  const auto scene = scene_of(puffs(), 4, 0.9, uneven());
  for (const Given& given : {Given{{"cells", "16"}}, paper}) {
    const scene::Film one = picture(method, scene, given, 1), two = picture(method, scene, given, 2);
    CHECK(one.layer("mean") == two.layer("mean"));
  }
}

TEST_CASE("compensated march: refusals name the reason", "[compensated_ray_marching]") {
  const auto reason = [](const scene::Scene& scene, const Given& given = {}) {
    const auto reasons = method.supports(scene, {method.settings(), given});
    return reasons.empty() ? std::string() : reasons.front();
  };
  auto scene = in_white(puffs(), 2);
  CHECK(reason(*scene).empty());
  CHECK(reason(*scene, paper).empty());
  scene->lights.push_back(scene::PointLight{});
  CHECK_THAT(reason(*scene), Contains("light 1 is point"));
  scene->lights[1] = scene::DirectionalLight{};
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("light 1 is directional"));
  scene->lights.pop_back();
  std::get<scene::GaussianSum>(scene->media[0].field).gaussians[0].amplitude = -0.1;
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("negative amplitude"));
  scene->media.push_back(scene->media[0]);
  CHECK_THAT(reason(*scene), Contains("more than one medium"));
  scene->media.resize(1);
  scene->media[0].field = scene::Homogeneous{};
  CHECK_THAT(reason(*scene), Contains("has no end"));
  scene->media[0].region = scene::Sphere{};
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("homogeneous"));
  CHECK_THROWS_WITH(reason(*scene, {{"multiple", "as_printed"}}), Contains("not for variant = grid"));
  scene->media[0].field = puffs();
  scene->media[0].region = scene::Unbounded{};
  scene->surfaces = {{"ball", scene::Sphere{}, scene::Lambert{}}};
  finish(*scene);
  CHECK(reason(*scene, paper).empty());
  CHECK_THAT(reason(*scene, {{"multiple", "p1"}}), Contains("p1 diffuses light through them"));
  scene->surfaces[0].material = scene::Phong{};
  CHECK(reason(*scene).empty());
  CHECK_THAT(reason(*scene, paper), Contains("surface 'ball' does not reflect as Lambert's"));
  scene->surfaces[0] = {"box", scene::make_box({Point3(-1, -1, -1), Point3(1, 1, 1)}), scene::Lambert{}};
  CHECK(reason(*scene, paper).empty());
  // Cells that stay too deep however small they are.
  CHECK_THROWS_AS(picture(method, in_white(puffs(), 1e4)), scene::NotSupported);
}

}  // namespace renderer_test
