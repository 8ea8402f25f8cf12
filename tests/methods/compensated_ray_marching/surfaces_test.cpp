// Surfaces in smoke and before it: shadows in closed form, spheres that stand for a mesh, rooms that are closed.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/compensated_ray_marching/sphere_sets.h"
#include "scene/geometry/round_shapes.h"
#include "scene/geometry/shapes.h"
#include "tests/methods/compensated_ray_marching/puffs.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"
#include "tests/pictures.h"

namespace surfaces_test {

using namespace airlight;
using namespace airlight::test;
using compensated_ray_marching::CompensatedRayMarching;

namespace {

const CompensatedRayMarching method;
const Given paper{{"variant", "paper"}};

}  // namespace

TEST_CASE("compensated march: a ball's shadow on the ground in an even light, in closed form",
          "[compensated_ray_marching]") {
  // Share of a ball in the irradiance on a plane that sees all of it at a distance d, at an angle from
  // the normal: (R/d)^2 cos.
  const double radius = 0.6, height = 1.5;
  auto scene = in_white(puffs(), 0);
  const bool smoke = GENERATE(false, true);
  if (smoke) scene->media[0].sigma_t = Rgb::Constant(1e-6);
  scene->camera = scene::look_at({0, 3, 3}, {0, -1, 0}, Vec3::UnitY());
  scene->camera.vertical_fov = 0.9;
  scene->surfaces = {{"ground", scene::Plane{{0, -1, 0}, Vec3::UnitY()}, scene::Lambert{Rgb::Constant(0.7)}},
                     {"ball", scene::Sphere{{0, height - 1, 0}, radius}, scene::Lambert{Rgb::Constant(0.2)}}};
  finish(*scene);
  // Directions: an edge falls between them; harmonics of 4 bands.
  const std::vector<std::tuple<Given, double, double>> kinds{
      {{{"levels", "24"}}, 0.03, 0.006},
      {{{"variant", "paper"}}, 0.03, 0.012},
      {{{"variant", "paper"}, {"transmittance", "ol"}}, 0.06, 0.03},
      {{{"variant", "paper"}, {"transmittance", "directional"}}, 0.05, 0.015}};
  for (const auto& [given, worst, root_mean] : kinds) {
    CAPTURE(given, smoke);
    const scene::Film film = picture(method, scene, given);
    double most = 0, sum = 0;
    int count = 0, in_shadow = 0;
    for (int y = 0; y < film.height; ++y)
      for (int x = 0; x < film.width; ++x) {
        const Ray ray = camera_ray(scene->camera, x + 0.5, y + 0.5, film.width, film.height);
        const auto hit = scene->geometry->first_hit(ray);
        if (!hit || hit->surface != 0) continue;
        const Vec3 way = Point3(0, height - 1, 0) - hit->position;
        const double hidden = std::pow(radius / way.norm(), 2) * way.normalized().y();
        const double off = film.get("surface", x, y)[0] / 0.7 - (1 - hidden);
        most = std::max(most, std::abs(off));
        sum += off * off;
        ++count;
        in_shadow += hidden > 0.1;
      }
    REQUIRE(count > 60);
    REQUIRE(in_shadow > 5);
    CHECK(most < worst);
    CHECK(std::sqrt(sum / count) < root_mean);
  }
}

// A ball as a mesh, 0.6 m wide.
scene::TriangleMesh ball_of_triangles(const Point3& center) {
  scene::DisplacedSphere ball;
  ball.center = center;
  ball.radii = Vec3::Constant(0.6);
  return scene::make_displaced_sphere(ball);
}

TEST_CASE("compensated march: spheres that stand for a mesh lie within it and fill it", "[compensated_ray_marching]") {
  namespace crm = compensated_ray_marching;
  const double cell = 1.2 / 24;
  const auto ball = crm::sphere_set(ball_of_triangles({1, 2, 3}), 1000);
  REQUIRE(!ball.empty());
  CHECK(ball[0].radius > 0.6 - cell);
  for (const scene::Sphere& s : ball) CHECK((s.center - Point3(1, 2, 3)).norm() + s.radius < 0.6 + cell);
  // A bar: balls in a row, as wide as it is.
  const auto bar = crm::sphere_set(scene::make_box({{-1, -0.2, -0.2}, {1, 0.2, 0.2}}), 12);
  REQUIRE(bar.size() > 4);
  CHECK(crm::sphere_set(scene::make_box({{-1, -0.2, -0.2}, {1, 0.2, 0.2}}), 3).size() == 3);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-1, 1), across(-0.2, 0.2);
  int covered = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point3 x(along(random), across(random), across(random));
    covered += std::any_of(bar.begin(), bar.end(), [&](const auto& s) { return (x - s.center).norm() < s.radius; });
  }
  CHECK(covered > 0.6 * 2000);
  for (const scene::Sphere& s : bar) CHECK((Vec3(1, 0.2, 0.2) - s.center.cwiseAbs()).minCoeff() > s.radius - 2.0 / 24);
  // A sheet encloses nothing.
  scene::TriangleMesh sheet = scene::make_box({{-1, -1, -1}, {1, 1, 1}});
  sheet.triangles.resize(2);
  CHECK(crm::sphere_set(sheet, 10).empty());
}

TEST_CASE("compensated march: published, a mesh shows shadows as a plane does, and casts them as a ball does",
          "[compensated_ray_marching]") {
  const auto with = [](scene::Shape ground, scene::Shape object) {
    auto scene = scene_of(puffs(), 3, 0.8, uneven());
    scene->camera = scene::look_at({0, 3, 3}, {0, -1, 0}, Vec3::UnitY());
    scene->camera.vertical_fov = 0.7;
    scene->surfaces = {{"ground", std::move(ground), scene::Lambert{Rgb(0.7, 0.6, 0.5)}},
                       {"ball", std::move(object), scene::Lambert{Rgb::Constant(0.2)}}};
    finish(*scene);
    return scene;
  };
  const scene::Plane plane{{0, -1, 0}, Vec3::UnitY()};
  const scene::TriangleMesh slab = scene::make_box({{-20, -1.5, -20}, {20, -1, 20}});
  const scene::Sphere ball{{1.1, -0.3, 0.4}, 0.6};
  for (const char* transmittance : {"hyb", "directional"}) {
    const Given given{{"variant", "paper"}, {"transmittance", transmittance}},
        flat{{"variant", "paper"}, {"transmittance", transmittance}, {"mesh_spheres", "0"}};
    CAPTURE(transmittance);
    const scene::Film on_plane = picture(method, with(plane, ball), given);
    CHECK(relative_l2(picture(method, with(slab, ball), flat), on_plane, "mean") < 1e-6);
    const scene::Film of_mesh = picture(method, with(plane, ball_of_triangles(ball.center)), given);
    const scene::Film without = picture(method, with(plane, ball_of_triangles(ball.center)), flat);
    CHECK(relative_l2(of_mesh, on_plane, "surface") < 0.03);
    CHECK(relative_l2(of_mesh, on_plane, "airlight") < 0.03);
    CHECK(relative_l2(without, on_plane, "surface") > 0.06);
    CHECK(relative_l2(without, on_plane, "airlight") > 0.06);
  }
}

TEST_CASE("compensated march: no light within a ball, none through a closed room", "[compensated_ray_marching]") {
  auto scene = in_white(puffs(), 3);
  scene->surfaces = {{"room", scene::Sphere{{0, 0, 0}, 3}, scene::Lambert{Rgb::Constant(0.5)}}};
  scene->camera = scene::look_at({0, 0, 2}, {0, 0, 0}, Vec3::UnitY());
  finish(*scene);
  for (const Given& given : {Given{}, paper, Given{{"variant", "paper"}, {"transmittance", "directional"}}}) {
    CAPTURE(given);
    const scene::Film film = picture(method, scene, given);
    const std::vector<float>& airlight = film.layer("airlight");
    CHECK(*std::max_element(airlight.begin(), airlight.end()) < 1e-5);
    CHECK(*std::min_element(film.layer("transmittance").begin(), film.layer("transmittance").end()) < 0.3);
  }
}

}  // namespace surfaces_test
