// Media so thin that hardly any path would collide: the relative error at a number of samples must not grow as the
// extinction falls, and what is forced must not change any mean.
#include <catch2/catch.hpp>
#include <cmath>

#include "reference/deterministic/airlight.h"
#include "scene/media/voxel_grid.h"
#include "tests/reference/path_tracer/scenes.h"

namespace thin_media_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

constexpr std::uint64_t samples = 1024;

scene::Medium cloud() {
  scene::GaussianSum sum;
  sum.gaussians = {{{0, 0, 0}, 0.5, 0.5}, {{0.5, 0.3, 0}, 0.3, 0.6}, {{-0.4, 0.2, 0.4}, 0.4, 0.4}};
  scene::Medium m = medium(scene::Sphere{{0, 0, 0}, 1}, 1, 0.9, phase_of("hg", 0.4));
  m.field = sum;
  return m;
}

scene::Medium voxels() {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {6, 5, 7};
  grid->voxel_size = 0.25;
  grid->translation = {-0.6, -0.5, -0.7};
  for (int i = 0; i < 6 * 5 * 7; ++i) grid->values.push_back(float((7 * i) % 11) / 11);
  scene::Medium m = medium(scene::Unbounded{}, 1, 0.8, phase_of("rayleigh"));
  m.field = std::shared_ptr<const scene::VoxelGrid>(grid);
  return m;
}

std::vector<scene::Medium> scaled(std::vector<scene::Medium> media, double extinction) {
  for (scene::Medium& m : media) m.sigma_t *= extinction;
  return media;
}

// Media to test: one of each kind, and two that overlap, of different colours.
std::vector<std::vector<scene::Medium>> media() {
  scene::Medium ball = medium(scene::Sphere{{0, 0, 0}, 1}, 1, 0.9, phase_of("hazy"));
  scene::Medium blue = ball, red = cloud();
  blue.sigma_t = {0.05, 0.4, 0.9};
  red.sigma_t = {1, 0.2, 0};
  return {{ball}, {cloud()}, {voxels()}, {blue, red}};
}

const scene::Surface black{"wall", scene::Plane{Point3(0, 0, -2), Vec3::UnitZ()}, scene::Lambert{Rgb::Zero()}};
const scene::Surface white_wall{"wall", scene::Plane{Point3(0, 0, -2), Vec3::UnitZ()},
                                scene::Lambert{Rgb::Constant(0.8)}};
const Ray through = ray_of({0.2, 0.1, 3}, {0.02, 0.01, -1});

}  // namespace

// Against quadrature, with nothing or a black wall behind. Before, from an extinction of about 1e-4 on, no path
// collided: radiance 0 with a standard error of 0. 4 media, 2 ends, 2 lights, 10 extinctions, 3 channels: 1e-3 false
// alarms of all of them.
TEST_CASE("thin media: flat relative error, and the quadrature's value", "[path_tracer]") {
  const double limit = threshold(1e-3, 4 * 2 * 2 * 10 * 3);
  int index = 0;
  for (const auto& kind : media())
    for (const bool wall : {false, true})
      for (const scene::Light& light : {scene::Light(scene::DirectionalLight{Vec3(0.6, 0.64, 0.48), Rgb(3, 2, 1)}),
                                        scene::Light(scene::PointLight{Point3(4, 5, 1), Rgb(30, 20, 10), 0})})
        for (const double extinction : {1., 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-15, 1e-22, 1e-30}) {
          const auto scene = scene_of(scaled(kind, extinction), {light},
                                      wall ? std::vector<scene::Surface>{black} : std::vector<scene::Surface>{});
          const World world(scene, Options{});
          const RadianceEstimate got = radiance(world, through, samples, {}, ++index);
          const Rgb truth =
              deterministic::airlight(*scene, through, wall ? 5 / -through.direction[2] : infinity).radiance;
          for (int c = 0; c < 3; ++c) {
            const double mean = got.orders[1].mean[c], error = got.orders[1].error[c];
            CAPTURE(index, kind.size(), wall, extinction, c, truth[c], mean, error);
            CHECK(std::abs(mean - truth[c]) <= limit * error + 1e-9 * truth[c]);
            // Where collisions are forced the error is a constant: at most 0.14 with a wall, where a quarter to a half
            // of the paths collide and a third of them in the wrong colour. From a scene depth of 0.05 on (extinction
            // 0.1) paths are analog: sqrt((1 / 0.02 - 1) / 1024) = 0.22 for one of depth 0.02.
            CHECK(error <= (extinction < 0.1 ? 0.16 : 0.25) * truth[c]);
          }
        }
}

// White environment: to first order in the extinction the ray scatters its optical depth times the albedo.
TEST_CASE("thin media in a white environment: flat relative error", "[path_tracer]") {
  const double limit = threshold(1e-3, 4 * 2 * 3 * 3);
  int index = 300;
  for (const auto& kind : media())
    for (const bool wall : {false, true})
      for (const double extinction : {1e-8, 1e-20, 1e-30}) {
        const auto scene = scene_of(scaled(kind, extinction), {white()},
                                    wall ? std::vector<scene::Surface>{white_wall} : std::vector<scene::Surface>{});
        // A wall of albedo 0.8 fills half of the sphere of directions with 0.8: order (1, 0) is all, order (1, 1) is
        // checked below.
        const RadianceEstimate got = radiance(World(scene, Options{}), through, samples, {}, ++index);
        Rgb scattered = Rgb::Zero();
        for (const scene::Medium& m : scene->media)
          scattered += m.sigma_t * m.albedo * scene::density_integral(m, through, {0, 5});
        for (int c = 0; c < 3; ++c) {
          const double mean = wall ? got.airlight[c] : got.orders[1].mean[c], error = got.orders[1].error[c];
          CAPTURE(index, kind.size(), wall, extinction, c, scattered[c], mean, error);
          if (!wall) CHECK(std::abs(mean - scattered[c]) <= limit * error + 1e-6 * scattered[c]);
          CHECK(error <= 0.16 * got.orders[1].mean[c]);
          CHECK(got.orders[1].mean[c] > 0);
        }
      }
}

// Light between a surface and a thin medium, either way: order 1 is proportional to the extinction. The one of 1e-4
// with many samples says the factor, up to its own optical depth.
TEST_CASE("thin media and the light of surfaces: flat relative error", "[path_tracer]") {
  const double limit = threshold(1e-3, 4 * 2 * 3 * 3);
  const std::vector<scene::Light> lights = {scene::PointLight{Point3(1.5, 0.5, -1), Rgb(3, 2, 1), 0},
                                            scene::DirectionalLight{Vec3(0.6, 0.64, 0.48), Rgb(3, 2, 1)}};
  int index = 400;
  for (const auto& kind : media())
    for (const auto paths : {Options::Paths::all, Options::Paths::scattered_to_surface}) {
      Options options;
      options.paths = paths;
      const auto run = [&](double extinction, std::uint64_t n) {
        const World world(scene_of(scaled(kind, extinction), lights, {white_wall}), options);
        return radiance(world, through, n, {}, ++index).orders[1];
      };
      const Estimate reference = run(1e-4, 1 << 16);
      for (const double extinction : {1e-6, 1e-15, 1e-30}) {
        const Estimate got = run(extinction, samples);
        for (int c = 0; c < 3; ++c) {
          const double mean = got.mean[c] / extinction, expected = reference.mean[c] / 1e-4;
          const double error = std::hypot(got.error[c] / extinction, reference.error[c] / 1e-4);
          CAPTURE(index, kind.size(), int(paths), extinction, c, expected, mean, error);
          CHECK(std::abs(mean - expected) <= limit * error + 1e-3 * expected);
          CHECK(got.error[c] <= 0.16 * got.mean[c]);
        }
      }
    }
}

// Where paths split (thin scenes with surfaces), and where they do not: the same means, order by order, as analog ones.
TEST_CASE("forced collisions before surfaces change the noise and nothing else", "[path_tracer][slow][thorough]") {
  const double limit = threshold(1e-3, 4 * 2 * 3 * 3 * 3);
  const scene::Surface ball{"ball", scene::Sphere{Point3(-0.6, -0.2, -0.3), 0.3}, scene::Lambert{Rgb(0.9, 0.6, 0.3)}};
  const std::vector<std::vector<scene::Light>> lights = {
      {white()},
      {scene::PointLight{Point3(0.4, 0.3, 0.2), Rgb(3, 2, 1), 0}},
      {white(), scene::PointLight{Point3(0.4, 0.3, 0.2), Rgb(3, 2, 1), 0}, scene::DirectionalLight{}}};
  int index = 500;
  for (const auto& kind : media())
    for (const Ray& ray : {through, ray_of({0.2, 0.1, 3}, {-0.25, -0.1, -1.1})})
      for (const auto& shining : lights) {
        const auto scene = scene_of(scaled(kind, 0.018), shining, {white_wall, ball});
        RadianceEstimate got[2];
        for (const bool forced : {false, true}) {
          Options options;
          options.forced = forced;
          const World world(scene, options);
          CHECK((world.boost() > 1) == forced);
          got[forced] = radiance(world, ray, 1 << 16, {}, ++index);
        }
        for (int m = 0; m < 3; ++m)
          for (int c = 0; c < 3; ++c) {
            const Estimate &a = m < 2 ? got[0].orders[m] : got[0].total, &b = m < 2 ? got[1].orders[m] : got[1].total;
            CAPTURE(index, kind.size(), shining.size(), m, c, a.mean[c], b.mean[c], a.error[c], b.error[c]);
            CHECK(std::abs(a.mean[c] - b.mean[c]) <= limit * std::hypot(a.error[c], b.error[c]) + 1e-12);
            if (m == 1) CHECK(b.error[c] < 0.02 * b.mean[c]);
          }
      }
}

// About 300 of 2^20 analog paths scatter twice: enough for a normal distribution if no light is close.
TEST_CASE("the second scattering after a forced one", "[path_tracer]") {
  const double limit = threshold(1e-3, 4 * 3);
  int index = 700;
  for (const auto& kind : media()) {
    const auto scene = scene_of(scaled(kind, 0.018), {white(), scene::DirectionalLight{}}, {white_wall});
    Estimate got[2];
    for (const bool forced : {false, true}) {
      Options options;
      options.forced = forced;
      got[forced] = radiance(World(scene, options), through, forced ? 1 << 17 : 1 << 20, {}, ++index).orders[2];
    }
    for (int c = 0; c < 3; ++c) {
      CAPTURE(index, c, got[0].mean[c], got[1].mean[c], got[0].error[c], got[1].error[c]);
      CHECK(std::abs(got[0].mean[c] - got[1].mean[c]) <= limit * std::hypot(got[0].error[c], got[1].error[c]));
    }
  }
}

}  // namespace thin_media_test
