// The renderer: closed forms, extremes (section 10 of the specification), what it refuses, frames after frames.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/compensated_ray_marching/gaussian_row.h"
#include "tests/pictures.h"

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
using compensated_ray_marching::CompensatedRayMarching;

namespace {

const CompensatedRayMarching method;
const Given paper{{"variant", "paper"}};

scene::GaussianSum puffs() {
  scene::GaussianSum sum;
  sum.cutoff = 3;
  sum.gaussians = {{{0, 0, 0}, 0.4, 1}, {{0.5, 0.2, -0.1}, 0.25, 0.7}, {{-0.3, 0.4, 0.2}, 0.3, 0.9}};
  return sum;
}

std::shared_ptr<scene::Scene> scene_of(scene::GaussianSum sum, double sigma_t, double albedo,
                                       scene::EnvironmentLight light) {
  auto s = std::make_shared<scene::Scene>();
  s->camera = scene::look_at({0.3, 0.5, 4}, {0, 0.1, 0}, Vec3::UnitY());
  s->camera.vertical_fov = 0.6;
  s->width = 12;
  s->height = 9;
  s->lights = {std::move(light)};
  scene::Medium smoke;
  smoke.field = std::move(sum);
  smoke.sigma_t = Rgb::Constant(sigma_t);
  smoke.albedo = Rgb::Constant(albedo);
  s->media = {smoke};
  finish(*s);
  return s;
}
std::shared_ptr<scene::Scene> in_white(scene::GaussianSum sum, double sigma_t, double albedo = 0.8) {
  return scene_of(std::move(sum), sigma_t, albedo, scene::make_constant_environment(Rgb::Ones()));
}
// 1 + 0.8 cos towards +y in the red, from the side in the others.
scene::EnvironmentLight uneven(double turn = 0) {
  const double one = std::sqrt(4 * pi), slope = std::sqrt(4 * pi / 3);
  const Mat3 rotation = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
  return scene::make_sh_environment(
      {Rgb::Constant(one), Rgb(-0.8 * slope, 0, 0.2), Rgb(0, 0.5, 0), Rgb(0, -0.5 * slope, 0.4)}, rotation,
      Rgb::Ones());
}

double greatest_difference(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  double most = 0;
  for (std::size_t i = 0; i < a.layer(layer).size(); ++i)
    most = std::max(most, std::abs(double(a.layer(layer)[i]) - b.layer(layer)[i]));
  return most;
}
bool finite(const scene::Film& film) {
  for (const auto& [name, values] : film.layers)
    for (const float v : values)
      if (!std::isfinite(v)) return false;
  return true;
}

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
    any_depth["deepest_cell"] = "1e9";
    const scene::Film thick = picture(method, in_white(puffs(), 1e4), any_depth);
    CHECK(finite(thick));
    const std::size_t middle = 3 * (4 * 12 + 6);
    CHECK(thick.layer("transmittance")[middle] == 0);
    for (const float v : thick.layer("mean")) REQUIRE((v >= 0 && v < (given.empty() ? 1.5 : 1e3)));
  }
}

TEST_CASE("compensated march: no Gaussian, one, two at one place, one without weight, the eye within",
          "[compensated_ray_marching]") {
  scene::GaussianSum none, empty, one, twins, idle = puffs();
  none.cutoff = empty.cutoff = one.cutoff = twins.cutoff = 3;
  empty.gaussians = {{{0, 0, 0}, 0.5, 0}};
  one.gaussians = {{{0, 0, 0}, 0.5, 1}};
  twins.gaussians = {{{0, 0, 0}, 0.5, 0.5}, {{0, 0, 0}, 0.5, 0.5}};
  idle.gaussians.push_back({{0, 0, 0}, 0.5, 0});
  for (const Given& given : {Given{}, paper}) {
    CAPTURE(given);
    for (const scene::GaussianSum& nothing : {none, empty}) {
      const scene::Film clear = picture(method, in_white(nothing, 2), given);
      for (const float v : clear.layer("mean")) REQUIRE(v == 1);
    }
    const scene::Film single = picture(method, in_white(one, 2), given),
                      both = picture(method, in_white(twins, 2), given);
    CHECK(finite(single));
    CHECK(relative_l2(both, single, "mean") < (given.empty() ? 1e-6 : 1e-3));
    CHECK(relative_l2(picture(method, in_white(idle, 2), given), picture(method, in_white(puffs(), 2), given), "mean") <
          1e-6);
    auto inside = in_white(puffs(), 2);
    inside->camera = scene::look_at({0.05, 0.1, 0}, {1, 0.1, 0}, Vec3::UnitY());
    finish(*inside);
    CHECK(finite(picture(method, inside, given)));
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
      CHECK(finite(film));
      for (const float v : film.layer("airlight")) REQUIRE(v >= 0);
    }
}

TEST_CASE("compensated march: the next frame's light as if prepared anew", "[compensated_ray_marching]") {
  for (const Given& given :
       {Given{{"tolerance", "1e-6"}}, Given{{"variant", "paper"}, {"iterations", "100"}, {"tolerance", "1e-10"}}}) {
    const auto before = scene_of(puffs(), 4, 0.9, uneven(2)), after = scene_of(puffs(), 4, 0.9, uneven(0.3));
    const scene::Settings settings{method.settings(), given};
    const auto prepared = method.prepare(before, settings, {1, {}});
    const auto times = prepared->next(after, {1, {}});
    REQUIRE(times);
    const scene::Film warm = prepared->render(view_of(*after), {1, {}}).film, cold = picture(method, after, given);
    CAPTURE(given);
    CHECK(greatest_difference(warm, cold, "mean") < 3e-6);
    CHECK(greatest_difference(warm, picture(method, before, given), "airlight") > 0.01);
    CHECK_FALSE(prepared->next(scene_of(puffs(), 5, 0.9, uneven()), {1, {}}));
    auto sun = scene_of(puffs(), 4, 0.9, uneven());
    sun->lights.push_back(scene::DirectionalLight{Vec3(1, 2, 2).normalized(), Rgb(1, 2, 3)});
    finish(*sun);
    if (given.count("variant")) continue;
    REQUIRE(prepared->next(sun, {1, {}}));
    CHECK(greatest_difference(prepared->render(view_of(*sun), {1, {}}).film, picture(method, sun, given), "mean") <
          1e-5);
  }
}

TEST_CASE("compensated march: the same bits for any number of threads", "[compensated_ray_marching]") {
  const auto scene = scene_of(puffs(), 4, 0.9, uneven());
  for (const Given& given : {Given{}, paper}) {
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
  // Cells that stay too deep however small they are.
  CHECK_THROWS_AS(picture(method, in_white(puffs(), 1e4)), scene::NotSupported);
}

TEST_CASE("Gaussians along a row of rays are their density", "[compensated_ray_marching]") {
  const scene::GaussianSum sum = puffs();
  const Ray ray{{-2, 0.15, 0.05}, Vec3(1, 0.02, 0.01).normalized()};
  const Vec3 normal = ray.direction.cross(Vec3(0, 0, 1)).normalized();
  const std::vector<Rgb> values{Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)};
  const compensated_ray_marching::GaussianRow row(sum, &values, ray.origin, normal);
  const compensated_ray_marching::RaySlices slices{0.1, 0.011, 380};
  std::vector<double> density(380, 0.0);
  std::vector<Rgb> weighted(380, Rgb::Zero());
  row.add(ray, slices, density.data(), weighted.data());
  for (int k = 0; k < slices.count; ++k) {
    const double expected = scene::density(sum, ray.at(slices.middle(k)));
    REQUIRE(std::abs(density[std::size_t(k)] - expected) < 1e-12);
    REQUIRE(std::abs(weighted[std::size_t(k)].sum() - expected) < 1e-12);
  }
}
