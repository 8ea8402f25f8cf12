// Smoke with hard edges on the grid: no light is made, against the path tracer and quadrature, and cells that are too deep are refused.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "reference/deterministic/renderer.h"
#include "reference/path_tracer/options.h"
#include "reference/path_tracer/single_rays.h"
#include "scene/media/legendre_box.h"
#include "tests/pictures.h"

namespace hard_edges_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

const compensated_ray_marching::CompensatedRayMarching method;

std::shared_ptr<scene::Scene> scene_of(const scene::Region& region, double sigma_t, double albedo, scene::Light light) {
  auto s = std::make_shared<scene::Scene>();
  s->camera = scene::look_at({0, 2, 5}, {0, 0, 0}, Vec3::UnitY());
  s->camera.kind = scene::Camera::Kind::orthographic;
  s->camera.height = 2.9;
  s->width = 15;
  s->height = 15;
  s->lights = {std::move(light)};
  scene::Medium fog;
  fog.region = region;
  fog.sigma_t = Rgb::Constant(sigma_t);
  fog.albedo = Rgb::Constant(albedo);
  s->media = {fog};
  finish(*s);
  return s;
}

// In an even light of 1 nothing is brighter than 1: at albedo 1 smoke cannot be told from what is behind it.
void no_light_is_made(const std::vector<std::pair<double, const char*>>& depths_and_cells) {
  const scene::Light even = scene::make_constant_environment(Rgb::Ones());
  const scene::Region ball = scene::Sphere{Point3::Zero(), 1}, box = Box{{-1, -0.7, -0.4}, {0.8, 1, 1}},
                      cube = Box{{-1, -1, -1}, {1, 1, 1}};
  for (const scene::Region& region : {ball, box, cube})
    for (const auto& [sigma_t, cells] : depths_and_cells) {
      // These cases take seconds each: cells as deep as at a depth of 5 need two or four times as many along a side.
      // The cube has more cells than the other box, which is skipped.
      if (sigma_t == 20 && std::holds_alternative<Box>(region) && std::get<Box>(region).hi[0] < 1) continue;
      CAPTURE(region_name(region), sigma_t);
      const Given given{{"cells", cells}};
      const scene::Film whole = picture(method, scene_of(region, sigma_t, 1, even), given);
      for (const float v : whole.layer("mean")) CHECK(std::abs(v - 1) < 1e-3);
      for (const double albedo : {0.5, 0.9, 0.99}) {
        if (sigma_t > 5 && albedo < 0.99) continue;  // seconds each, and darker than the last
        CAPTURE(albedo);
        const scene::Film part = picture(method, scene_of(region, sigma_t, albedo, even), given);
        for (const float v : part.layer("mean")) CHECK(v < 1 + 1e-5);
      }
    }
}

}  // namespace

TEST_CASE("compensated march at hard edges: no light is made in thick cells", "[compensated_ray_marching]") {
  no_light_is_made({{5, "8"}, {10, "16"}, {1, "8"}});
}

TEST_CASE("compensated march at hard edges: no light is made in thick cells, 32 a side",
          "[compensated_ray_marching][thorough]") {
  no_light_is_made({{20, "32"}});
}

// Balls of 5, 10 and 20 depths in radius, albedo .99. Twelve rays within 2 % (of the cells, 1.3 deep) and 5.5 standard errors of the path
// tracer, which gives a false alarm in 1e-6 runs. In an even light of 1 nothing is brighter than 1.
TEST_CASE("compensated march at hard edges: rays out of thick balls against the path tracer",
          "[compensated_ray_marching]") {
  const scene::Settings none(path_tracer::setting_specs(), {});
  for (const double sigma_t : {5.0, 10.0, 20.0}) {
    const auto s =
        scene_of(scene::Sphere{Point3::Zero(), 1}, sigma_t, 0.99, scene::make_constant_environment(Rgb::Ones()));
    const path_tracer::World world(s, path_tracer::parse_options(none));
    const auto prepared = method.prepare(s, {method.settings(), {}}, {0, {}});
    for (const double impact : {0.1, 0.5, 0.8, 0.95}) {
      const Point3 eye(impact, 0, 3);
      const auto truth = path_tracer::radiance(world, {eye, -Vec3::UnitZ()}, 1 << 13, {0, {}}).total;
      const scene::Film film =
          prepared->render({scene::look_at(eye, eye - Vec3::UnitZ(), Vec3::UnitY()), 1, 1}, {1, {}}).film;
      const Rgb got = film.get("mean", 0, 0);
      CAPTURE(sigma_t, impact, got, truth.mean, truth.error);
      CHECK((truth.error < 0.01 * truth.mean).all());
      CHECK(((got - truth.mean).abs() < 0.02 * truth.mean + 5.5 * truth.error).all());
      CHECK((got <= 1 + 1e-5).all());
    }
  }
}

TEST_CASE("compensated march at hard edges: single scattering of a sun in deep cells is right, or refused",
          "[compensated_ray_marching]") {
  scene::DirectionalLight sun;
  sun.to_light = Vec3(1, 2, 1).normalized();
  sun.irradiance = Rgb::Constant(2);
  const auto exact = deterministic::make_renderer();
  const Given once{{"multiple", "none"}};
  for (const scene::Region& region :
       {scene::Region(Box{{-1, -1, -1}, {1, 1, 1}}), scene::Region(scene::Sphere{Point3::Zero(), 1})}) {
    for (const double sigma_t : {0.5, 5.0, 20.0}) {
      CAPTURE(region_name(region), sigma_t);
      const auto scene = scene_of(region, sigma_t, 1, sun);
      CHECK(relative_l2(picture(method, scene, once), picture(*exact, scene)) < 0.05);
    }
    for (const double sigma_t : {100.0, 1e4})
      CHECK_THROWS_AS(picture(method, scene_of(region, sigma_t, 1, sun), once), scene::NotSupported);
  }
  CHECK_THROWS_AS(
      picture(method, scene_of(Box{{-1, -1, -1}, {1, 1, 1}}, 100, 1, scene::make_constant_environment(Rgb::Ones())),
              once),
      scene::NotSupported);
}

TEST_CASE("compensated march: a sun alone is looked for in one direction", "[compensated_ray_marching]") {
  scene::DirectionalLight sun;
  const Given small{{"cells", "8"}};
  const auto directions = [&](const std::shared_ptr<scene::Scene>& scene) {
    for (const scene::Stage& s : method.prepare(scene, {method.settings(), small}, {1, {}})->stages())
      if (s.name == "single scattering") return s.reason;
    return std::string();
  };
  const scene::Region ball = scene::Sphere{Point3::Zero(), 1};
  const auto scene = scene_of(ball, 1, 0.9, sun);
  CHECK_THAT(directions(scene), Contains(", 1 directions"));
  const auto sky = scene_of(ball, 1, 0.9, scene::make_constant_environment(Rgb::Ones()));
  CHECK_THAT(directions(sky), Contains(", 128 directions"));
  const auto prepared = method.prepare(scene, {method.settings(), small}, {1, {}});
  // Another kind of light is prepared anew, but for where its iterations begin.
  REQUIRE(prepared->next(sky, {1, {}}));
  CHECK_THAT(prepared->stages()[0].reason, Contains(", 128 directions"));
  CHECK(relative_l2(prepared->render(view_of(*sky), {1, {}}).film, picture(method, sky, small)) < 3e-4);
}

}  // namespace hard_edges_test
