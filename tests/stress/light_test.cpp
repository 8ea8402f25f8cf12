// Stress cases 10 to 13, 27 and 28: lights in awkward places and of awkward shapes.
#include <functional>

#include "reference/path_tracer/sampling.h"
#include "scene/media/voxel_grid.h"
#include "tests/stress/stress.h"

namespace light_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

// A uniform direction from the origin.
Ray from_the_middle(const RandomBlock& u) { return {{0, 0, 0}, uniform_direction(u.fine(0), u.fine(1))}; }

// All that was scattered: the sum over orders >= 1, its standard error at most the sum of theirs.
void check_scattered(double expected, const path_tracer::RadianceEstimate& e, double resolution) {
  double mean = 0, error = 0;
  for (std::size_t m = 1; m < e.orders.size(); ++m) {
    mean += e.orders[m].mean[0];
    error += e.orders[m].error[0];
  }
  check_equal(expected, mean, error, resolution);
}

scene::EnvironmentLight map_of(int width, int height, const std::function<float(int, int)>& value) {
  auto map = std::make_shared<scene::EnvironmentMap>();
  map->width = width;
  map->height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) map->rgb.push_back(value(x, y));
  return scene::make_map_environment(map, Mat3::Identity(), Rgb::Ones(), "test");
}

}  // namespace

// In a thin uniform medium L = sigma_t p I pi / h (1 - O(sigma_t)) as h -> 0: the two transmittances within some
// metres.
TEST_CASE("stress 10: a light at 1e-9 from a camera ray", "[stress]") {
  const double sigma = 1e-3;
  const Ray ray{{0, 0, 0}, Vec3::UnitZ()};
  double product[2];
  for (const double h : {1e-6, 1e-9}) {
    const auto scene =
        scene_of({medium(scene::Sphere{{0, 0, 0}, 10}, sigma, 1)}, {scene::PointLight{{0, h, 2}, Rgb::Ones()}});
    const auto exact = deterministic::airlight(*scene, ray, infinity);
    CHECK(exact.converged);
    CHECK(exact.radiance[0] * h == Approx(sigma / 4 * std::exp(-2 * sigma)).epsilon(1e-5));
    product[h == 1e-9] = exact.radiance[0] * h;
    // The path tracer draws points in equal angles: nearly without noise, and its error says so.
    const auto traced = radiance(World(scene, Options{}), ray, 4096, {}, 100);
    CHECK(traced.total.mean.allFinite());
    check_equal(exact.radiance[0], traced.orders[1], 0.02);
    // A picture whose middle pixel looks past the light.
    scene::View view = view_from({0, 0, 0}, {0, 0, 1}, 3);
    for (const char* const name : renderers) CHECK(all_finite(picture(name, scene, view)));
  }
  // L h tends to a constant; what is left over, h times the airlight from afar, is of the order of h.
  CHECK(product[1] == Approx(product[0]).epsilon(1e-5));
}

TEST_CASE("stress 11: a light on the camera", "[stress]") {
  const Point3 eye(0.1, 0.2, 0.3);
  auto scene = scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, 1, 0.9)}, {scene::PointLight{eye}});
  const scene::View view = view_from(eye, {1, 1, 1}, 4);
  scene->camera = view.camera;
  for (const char* const name : renderers) {
    const auto reasons = stress::refusals(name, *scene);
    CAPTURE(name);
    if (reasons.empty()) {  // engines' fog takes a lamp to be a centimetre away at least
      CHECK((std::string(name) == "froxel_fog" || std::string(name) == "half_resolution_march"));
      CHECK(all_finite(picture(name, scene, view)));
      continue;
    }
    REQUIRE(reasons.size() == 1);
    CHECK_THAT(reasons.front(), Catch::Contains("camera") && Catch::Contains("infinite"));
    CHECK_THROWS_AS(picture(name, scene, view), Error);
  }
  // In vacuum, or as a ball, it has an answer.
  auto vacuum = scene_of({}, {scene::PointLight{eye}});
  vacuum->camera = view.camera;
  for (const char* const name : renderers) {
    CAPTURE(name);
    CHECK(stress::refusals(name, *vacuum).empty());
    CHECK(all_finite(picture(name, vacuum, view)));
  }
}

TEST_CASE("stress 12: a light in the middle of a sphere of optical radius 100", "[stress]") {
  // Light that escapes from the middle is, by reciprocity, the light of a white sky at the middle: all
  // of it at albedo 1.
  const auto ball = [](double albedo) { return medium(scene::Sphere{{0, 0, 0}, 1}, 100, albedo); };
  const auto seen = mean_radiance(World(scene_of({ball(1)}, {white()}), Options{}), from_the_middle, 256, {}, 120);
  check_equal(1, seen.total, 0.05);
  CHECK(double(seen.counters.collisions) > 1000.0 * double(seen.samples));
  // At albedo 0.9 nothing comes through (about exp(-50)) that a few samples could find: said, not shown as 0.
  const auto dark = scene_of({ball(0.9)}, {scene::PointLight{{0, 0, 0}}});
  const scene::View view = view_from({0, 0, 3}, {0, 0, 0}, 4);
  dark->camera = view.camera;
  const scene::Film film = picture("path_tracer", dark, view, {{"samples", "256"}});
  CHECK(all_finite(film));
  REQUIRE(film.metadata.count("unresolved"));
  CHECK_THAT(film.metadata.at("unresolved"), Catch::Contains("order.rest"));
}

// A light on a face, and the same light moved off it: no double count, no light lost.
TEST_CASE("stress 13: a light exactly on a voxel face, a supergrid face, the domain face", "[stress]") {
  scene::VoxelGrid grid;
  grid.size = {8, 8, 8};
  grid.voxel_size = 0.25;  // supergrid cells of four voxels: faces at multiples of 1 from the corner
  for (int i = 0; i < 512; ++i) grid.values.push_back(float(1 + (7 * i) % 5) / 3);
  const Ray ray = ray_of({0.6, 0.9, -2}, {0.1, 0.05, 1});
  const double nudge = 1e-9;
  int index = 130;
  for (const Point3& face : {Point3(0.5, 0.7, 0.8), Point3(0.75, 0.75, 0.75), Point3(-0.25, 0.6, 0.8),
                             Point3(0.7, 2, 0.9), Point3(0.5, 0.5, 0.5)}) {
    std::vector<double> values;
    for (const double step : {0.0, nudge, -nudge}) {
      const auto scene = scene_of({of_grid(grid, 2, 0.8)}, {scene::PointLight{face + Point3::Constant(step)}});
      const auto exact = deterministic::airlight(*scene, ray, infinity);
      CHECK(exact.converged);
      values.push_back(exact.radiance[0]);
      if (step == 0)
        check_equal(exact.radiance[0], radiance(World(scene, Options{}), ray, 1 << 13, {}, ++index).orders[1], 0.05);
    }
    // The radiance changes by its gradient times the step: at 0.1 from the ray a few tens per metre.
    CHECK(values[1] == Approx(values[0]).epsilon(1e-7));
    CHECK(values[2] == Approx(values[0]).epsilon(1e-7));
  }
}

TEST_CASE("stress 27: environments with negative lobes, a texel of 1e9, all black", "[stress]") {
  const scene::Medium ball = medium(scene::Sphere{{0, 0, 0}, 1}, 1.5, 1);
  // From the middle, averaged over directions, an isotropic sphere sees the mean of any sky; order 0 has exp(-1.5) of
  // it. The band-1 part averages to nothing, and makes half of the sky negative.
  const double mean = 0.5 * std::sqrt(4 * pi) / (4 * pi);
  const auto lobes = scene::make_sh_environment({Rgb::Constant(0.5), Rgb::Zero(), Rgb::Constant(-3), Rgb::Zero()},
                                                Mat3::Identity(), Rgb::Ones());
  CHECK(scene::negative_fraction(lobes) > 0.3);
  const auto scene = scene_of({ball}, {lobes});
  check_scattered(mean * (1 - std::exp(-1.5)),
                  mean_radiance(World(scene, Options{}), from_the_middle, 1 << 15, {}, 271), 0.2);
  // Towards +z it is negative, and stays so in the picture.
  const scene::Film film = picture("path_tracer", scene, view_from({0, 0, 0.9}, {0, 0, 2}, 3), {{"samples", "1024"}});
  CHECK(film.get("order.0", 1, 1)[0] < 0);
  CHECK(film.get("mean", 1, 1)[0] < 0);
  CHECK(film.get("negative", 1, 1)[0] < 0);
  CHECK(all_finite(film));

  // One texel of 1e9 on a sky of 1.
  const auto hot = map_of(64, 32, [](int x, int y) { return x == 20 && y == 9 ? 1e9f : 1.0f; });
  const auto e = mean_radiance(World(scene_of({ball}, {hot}), Options{}), from_the_middle, 1 << 15, {}, 272);
  check_scattered(scene::environment_power(hot) / (4 * pi) * (1 - std::exp(-1.5)), e, 0.05);
  // The rule for fireflies: no sample holds more than 5 % of the sum. A fixed ray that does not see the texel itself.
  const auto fixed =
      radiance(World(scene_of({ball}, {hot}), Options{}), ray_of({0, 0, 0}, {0, -1, 0}), 1 << 14, {}, 273);
  CHECK(fixed.greatest[0] < 0.05 * double(fixed.samples) * fixed.total.mean[0]);
  CHECK(fixed.total.error[0] < 0.05 * fixed.total.mean[0]);

  const auto black = map_of(16, 8, [](int, int) { return 0.0f; });
  const auto dark = scene_of({ball}, {black});
  const auto view = view_from({0, 0, 3}, {0, 0, 0}, 4);
  for (const char* const name : renderers) {
    const scene::Film nothing = picture(name, dark, view);
    CAPTURE(name);
    CHECK(all_finite(nothing));
    for (const float v : nothing.layer("mean")) CHECK(v == 0);
  }
}

TEST_CASE("stress 28: spot cones of 1e-4 rad and of 180 degrees", "[stress]") {
  const double angle = 1e-4, I = 5;
  // A needle of light on a white wall one metre away: the flux I 2 pi (1 - cos angle), summed over a line of pixels
  // through its middle as rings. An edge that falls within a pixel shifts the radius by at most one pixel of 1000:
  // 2e-3.
  const scene::SpotLight needle{{0, 0, 0}, -Vec3::UnitZ(), angle, angle, Rgb::Constant(I)};
  const auto wall =
      scene_of({}, {needle}, {{"wall", scene::Plane{{0, 0, -1}, Vec3::UnitZ()}, scene::Lambert{Rgb::Ones()}}});
  scene::View view;
  view.width = 2400;
  view.height = 1;
  view.camera = scene::look_at({0, 0, 1}, {0, 0, -1}, Vec3::UnitY());
  view.camera.kind = scene::Camera::Kind::orthographic;
  view.camera.height = 2.4 * angle / view.width;
  const double step = 2.4 * angle / view.width;
  for (const char* const name : renderers) {
    const scene::Film film =
        picture(name, wall, view, std::string(name) == "path_tracer" ? Given{{"samples", "1"}} : Given{});
    double flux = 0;
    for (int x = 0; x < view.width; ++x) {
      const double r = std::abs(x + 0.5 - 0.5 * view.width) * step;
      flux += film.get("surface", x, 0)[0] * pi * pi * r * step;  // radiance pi = irradiance; half a ring per pixel
    }
    CAPTURE(name);
    CHECK(flux == Approx(I * pi * angle * angle).epsilon(2e-3));
  }
  // Across the needle at distance 2 in thin air: sigma_t p I times the chord 2 d tan(angle) over d^2, the distance
  // constant to angle^2.
  const auto air = scene_of({medium(scene::Unbounded{}, 1e-9, 1)}, {needle});
  const auto across = deterministic::airlight(*air, {{1, 0, -2}, -Vec3::UnitX()}, infinity);
  CHECK(across.converged);
  CHECK(across.radiance[0] == Approx(1e-9 / (4 * pi) * I * 2 * angle / 2).epsilon(1e-6));

  // Everything lies within 180 degrees: a point light.
  const scene::Medium ball = medium(scene::Sphere{{0, 0, 0}, 1}, 1.5, 1);
  const Point3 position(0.3, -0.2, 0.4);
  const auto round = scene_of({ball}, {scene::SpotLight{position, Vec3::UnitX(), pi, pi, Rgb::Constant(I)}});
  const auto point = scene_of({ball}, {scene::PointLight{position, Rgb::Constant(I)}});
  const Ray ray = ray_of({0.1, 0.2, 3}, {0, 0, -1});
  const double expected = deterministic::airlight(*point, ray, infinity).radiance[0];
  CHECK(deterministic::airlight(*round, ray, infinity).radiance[0] == Approx(expected).epsilon(1e-9));
  check_equal(expected, radiance(World(round, Options{}), ray, 1 << 13, {}, 281).orders[1], 0.05);
  // Its flux: seen from all sides of the sphere, scattered and direct make 4 pi I.
  const auto entering = [](const RandomBlock& u) {
    const Vec3 outward = uniform_direction(u.coarse(0), u.coarse(1));
    return Ray{outward, path_tracer::turned(-outward, std::sqrt(u.coarse(2)), u.coarse(3))};
  };
  double direct = 0;
  const int m = 300;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      const double b = position.dot(uniform_direction((i + 0.5) / m, (j + 0.5) / m));
      direct += std::exp(-1.5 * (-b + std::sqrt(b * b + 1 - position.squaredNorm()))) / (m * m);
    }
  Estimate flux = mean_radiance(World(round, Options{}), entering, 1 << 16, {}, 282).total;
  flux.mean *= pi / I;
  flux.error *= pi / I;
  check_equal(1 - direct, flux, 0.03);
}

}  // namespace light_test
