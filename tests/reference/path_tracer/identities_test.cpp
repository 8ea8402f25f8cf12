// Answers known without any other program: conservation, counts, reciprocity.
#include <catch2/catch.hpp>

#include "reference/path_tracer/sampling.h"
#include "scene/media/voxel_grid.h"
#include "tests/reference/path_tracer/scenes.h"

namespace identities_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

// All statistical comparisons of this file together raise a false alarm with probability 1e-3; seeds are fixed.
constexpr int comparisons = 60;
const double limit = threshold(1e-3, comparisons);

void check_equal(double expected, const Estimate& e, double own_error = 0) {
  const double error = std::hypot(e.error[0], own_error);
  CAPTURE(expected, e.mean[0], error);
  CHECK(std::abs(e.mean[0] - expected) <= limit * error + 1e-12 * std::abs(expected));
}

scene::Medium gaussian_cloud(double strength, const scene::PhaseFunction& phase) {
  scene::GaussianSum sum;
  sum.gaussians = {{{0, 0, 0}, 0.5, 1}, {{0.5, 0.3, 0}, 0.3, 2}, {{-0.4, 0.2, 0.4}, 0.4, 0.7}};
  scene::Medium m = medium(scene::Sphere{{0, 0, 0}, 1}, strength, 1, phase);
  m.field = sum;
  return m;
}

scene::Medium voxel_cloud(double strength, const scene::PhaseFunction& phase) {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {6, 5, 7};
  grid->voxel_size = 0.25;
  grid->rotation = Eigen::AngleAxisd(0.4, Vec3(1, -1, 2).normalized()).toRotationMatrix();
  grid->translation = {-0.6, -0.5, -0.7};
  for (int i = 0; i < 6 * 5 * 7; ++i) grid->values.push_back(float((7 * i) % 11) / 10);
  scene::Medium m = medium(scene::Unbounded{}, strength, 1, phase);
  m.field = std::shared_ptr<const scene::VoxelGrid>(grid);
  return m;
}

// A ray into the unit sphere about the origin, cosine-weighted and uniform on its surface.
Ray entering_sphere(const RandomBlock& u) {
  const double z = 2 * u.coarse(0) - 1;
  const Vec3 outward = turned(Vec3(0, 0, 1), z, u.coarse(1));
  return {outward, turned(-outward, std::sqrt(u.coarse(2)), u.coarse(3))};
}

}  // namespace

// Albedo 1 in a uniform environment: every ray sees 1, whatever the field and the phase function.
TEST_CASE("furnace", "[path_tracer]") {
  int index = 0;
  for (const scene::PhaseFunction& phase :
       {phase_of("isotropic"), phase_of("rayleigh"), phase_of("hg", 0.999), phase_of("hg", -0.999),
        phase_of("hg", 0.75), phase_of("hazy"), phase_of("murky")})
    for (const scene::Medium& m :
         {medium(scene::Sphere{{0, 0, 0}, 1}, 2.5, 1, phase), gaussian_cloud(2, phase), voxel_cloud(5, phase)}) {
      const World world(scene_of({m}, {white()}), Options{});
      const auto e = radiance(world, ray_of({0.3, 0.2, -3}, {0, 0.02, 1}), 16384, {}, ++index);
      CAPTURE(scene::phase_name(phase), scene::field_name(m.field));
      check_equal(1, e.total);
      CHECK(e.counters.violations == 0);
      // Nothing else can go wrong if the collisions are so many that order 0 and 1 do not carry the result.
      CHECK(e.orders[0].mean[0] < 0.5);
    }
}

// A path that enters a convex body cosine-weighted and uniform over its surface collides on average
// 4 int scattering dV / surface times, for any field and phase function at albedo 1 (mean chord 4 V / S).
TEST_CASE("mean number of collisions", "[path_tracer]") {
  const std::uint64_t n = 1 << 16;
  const auto count = [&](const scene::Medium& m, const RaySource& source, double expected, int index) {
    Options options;
    options.forced = false;
    const World world(scene_of({m}, {}), options);
    const auto e = mean_radiance(world, source, n, {}, index);
    const double mean = double(e.counters.collisions) / double(n);
    // The number of collisions has a spread of about its mean plus one (a little more than geometric for backward
    // scattering in thick bodies, which these are not): the standard error is taken as 1.5 (mean + 1) / sqrt(n).
    const double error = 1.5 * (expected + 1) / std::sqrt(double(n));
    CAPTURE(mean, expected, error);
    CHECK(std::abs(mean - expected) < limit * error);
    CHECK(error < 0.02 * expected);
  };
  int index = 100;
  for (const scene::PhaseFunction& phase : {phase_of("isotropic"), phase_of("hg", 0.75), phase_of("hg", -0.5)}) {
    // Sphere of optical radius 2: 4 tau / 3.
    count(medium(scene::Sphere{{0, 0, 0}, 1}, 2, 1, phase), entering_sphere, 8.0 / 3, ++index);
    // Cube of optical edge 3: 2 tau / 3.
    count(
        medium(Box{{0, 0, 0}, {1, 1, 1}}, 3, 1, phase),
        [](const RandomBlock& u) {
          const int face = std::min(5, int(6 * u.coarse(0)));
          const double sub = 6 * u.coarse(0) - face;  // the rest of the bits as one coordinate
          Point3 x;
          x[face % 3] = face < 3 ? 0 : 1;
          x[(face + 1) % 3] = sub;
          x[(face + 2) % 3] = u.coarse(1);
          Vec3 inward = Vec3::Zero();
          inward[face % 3] = face < 3 ? 1 : -1;
          return Ray{x, turned(inward, std::sqrt(u.coarse(2)), u.coarse(3))};
        },
        2.0, ++index);
    // Slab of depth 1.5: 2 tau.
    count(
        medium(scene::Slab{{0, 1, 0}, 0, 1}, 1.5, 1, phase),
        [](const RandomBlock& u) {
          return Ray{{0, 0, 0}, turned(Vec3(0, 1, 0), std::sqrt(u.fine(0)), u.fine(1))};
        },
        3.0, ++index);
    // A cloud in a sphere: 4 int scattering dV / (4 pi), the integral by radial-and-angular midpoints here.
    const scene::Medium cloud = gaussian_cloud(2, phase);
    double integral = 0;
    const int m = 60;
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j)
        for (int k = 0; k < m; ++k)
          integral += scene::density(cloud, Point3(i + 0.5, j + 0.5, k + 0.5) * (2.0 / m) - Point3::Ones());
    integral *= 2 * std::pow(2.0 / m, 3);
    count(cloud, entering_sphere, integral / pi, ++index);
  }
}

// A point light I = 1 in a sphere of albedo 1: what leaves, scattered and direct, is 4 pi.
TEST_CASE("energy: emitted is escaped", "[path_tracer]") {
  for (const bool central : {true, false}) {
    const Point3 x = central ? Point3(0, 0, 0) : Point3(0.3, -0.2, 0.4);
    const double tau = 1.5;
    const World world(
        scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, tau, 1, phase_of("hg", 0.3))}, {scene::PointLight{x}}),
        Options{});
    CHECK(world.lights().any_connected());
    // Radiance that leaves, seen by rays that enter the other way: flux = area * pi * mean.
    const auto e = mean_radiance(world, entering_sphere, 1 << 17, {}, 200 + central);
    // Direct light: mean over directions of exp(-distance to the sphere), by midpoints.
    double direct = 0;
    const int m = 400;
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j) {
        const Vec3 d = turned(Vec3(0, 0, 1), -1 + (2 * i + 1.0) / m, (j + 0.5) / m);
        const double b = x.dot(d);
        direct += std::exp(-tau * (-b + std::sqrt(b * b + 1 - x.squaredNorm()))) / (m * m);
      }
    Estimate share = e.total;
    share.mean *= 4 * pi * pi / (4 * pi);
    share.error *= 4 * pi * pi / (4 * pi);
    check_equal(1 - direct, share);
    CHECK(share.error[0] < 0.01);
  }
}

// Absorbed and escaped make up what was emitted, order by order: with albedo a, order m of the flux that leaves is a^m
// times that of albedo 1. So the orders of one run predict those of the other.
TEST_CASE("orders scale with powers of the albedo", "[path_tracer]") {
  const auto run = [](double albedo, int index) {
    Options options;
    options.orders = 5;
    const World world(scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, 2, albedo, phase_of("hg", -0.3))}, {white()}),
                      options);
    return radiance(world, ray_of({0.3, 0.2, -3}, {0, 0, 1}), 1 << 16, {}, index);
  };
  const auto full = run(1, 300), part = run(0.6, 301);
  for (int m = 1; m <= 5; ++m) {
    const double factor = std::pow(0.6, m);
    check_equal(factor * full.orders[m].mean[0], part.orders[m], factor * full.orders[m].error[0]);
  }
}

// Swapping an isotropic point light and an isotropic detector changes nothing (Helmholtz). Both lie inside the medium.
TEST_CASE("reciprocity", "[path_tracer]") {
  const Point3 a(0.4, -0.1, 0.2), b(-0.5, 0.3, -0.3);
  for (const scene::Medium& m : {medium(scene::Sphere{{0, 0, 0}, 1}, 2, 0.9, phase_of("hg", 0.5)),
                                 gaussian_cloud(2, phase_of("rayleigh")), voxel_cloud(4, phase_of("hazy"))}) {
    Estimate there[2];
    for (const bool swapped : {false, true}) {
      const World world(scene_of({m}, {scene::PointLight{swapped ? b : a}}), Options{});
      const auto e = mean_radiance(
          world,
          [&](const RandomBlock& u) {
            return Ray{swapped ? a : b, turned(Vec3(0, 0, 1), 2 * u.fine(0) - 1, u.fine(1))};
          },
          1 << 16, {}, 400 + swapped);
      there[swapped] = e.total;
    }
    check_equal(there[0].mean[0], there[1], there[0].error[0]);
    CHECK(there[0].error[0] < 0.03 * there[0].mean[0]);
  }
}

TEST_CASE("without albedo there is no scattered light", "[path_tracer]") {
  const World world(scene_of({medium(scene::Sphere{{0, 0, 0}, 1}, 2, 0)},
                             {white(), scene::PointLight{{0.2, 0.1, 0}}, scene::DirectionalLight{}}),
                    Options{});
  const auto e = radiance(world, ray_of({0.3, 0.2, -3}, {0, 0, 1}), 1024);
  for (int m = 1; m <= 5; ++m) CHECK(e.orders[m].mean[0] == 0);
  CHECK(e.airlight[0] == 0);
}

}  // namespace identities_test
