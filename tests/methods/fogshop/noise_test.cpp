#include "methods/fogshop/noise.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/fogshop.h"
#include "tests/pictures.h"

namespace noise_test {

using namespace airlight;
using namespace airlight::fogshop;
using Pairs = std::map<std::string, std::string>;

namespace {

scene::Film render(const char* name, const Pairs& given, int threads = 1) {
  const auto scene = std::make_shared<const scene::Scene>(
      scene::load_scene(std::string(AIRLIGHT_SOURCE_DIR "/experiments/scenes/fogshop/") + name + ".toml"));
  return airlight::test::picture(Fogshop(), scene, given, threads);
}

}  // namespace

// 0 at the lattice, within [-1, 1], continuous across cells, the same after 32 cells; places and shifts are dyadic, so
// that the period is exact.
TEST_CASE("noise tiles", "[fogshop]") {
  const Noise noise(0.25, 0.5, 7, 0);
  double least = 0, most = 0, sum = 0;
  int count = 0;
  for (double x = -9; x < 9; x += 0.59375)
    for (double y = -9; y < 9; y += 0.71875)
      for (double z = -9; z < 9; z += 0.84375) {
        const Vec3 n = noise.at({x, y, z});
        for (int k = 0; k < 3; ++k) CHECK((noise.at(Vec3(x, y, z) + 64 * Vec3::Unit(k)) == n));
        CHECK((noise.at({x + 1e-7, y, z}) - n).norm() < 1e-6);
        least = std::min(least, n.minCoeff());
        most = std::max(most, n.maxCoeff());
        sum += n.sum();
        count += 3;
      }
  CHECK(least >= -1);
  CHECK(most <= 1);
  CHECK(least < -0.6);
  CHECK(most > 0.6);
  CHECK(std::abs(sum / count) < 0.01);
  CHECK(noise.at({2, -6, 8}).isZero());
  // Another seed is another noise; a phase is a shift.
  const Noise other(0.25, 0.5, 8, 0), shifted(0.25, 0.5, 7, 0.5);
  CHECK((other.at({0.3, 0.4, 0.5}) - noise.at({0.3, 0.4, 0.5})).norm() > 1e-3);
  CHECK((shifted.at({0.25, 0.5, 0.75}) == noise.at({1.25, 1.5, 1.75})));
}

// Two cameras that look at the centre of a Gaussian have the same b_i^r and so the same n: both see the Gaussian where
// the line to its centre is moved by n scale r_i in the world, whatever their distance and view.
TEST_CASE("noise is fixed in the world", "[fogshop]") {
  const Noise noise(0.3, 1.3, 1, 0.2);
  const Point3 center(0.37, 0.81, 4.19);
  const double radius = 1.5;
  const Vec3 moved = center + 0.3 * radius * noise.at(center);
  for (const Point3& view : {Point3(0, 0, 0), Point3(20, 5, -3), Point3(0, 7, 4)}) {
    const Vec3 r = noise.bent(view, (center - view).normalized(), center, radius, center);
    CHECK(r.norm() == Approx(1));
    CHECK((r.cross(moved - view)).norm() < 1e-12 * (moved - view).norm());
  }
  // Inside, rays are bent by n scale at most.
  const Vec3 inside = noise.bent(center + Vec3(0.1, 0, 0), Vec3::UnitZ(), center, radius, center);
  CHECK((inside - (Vec3::UnitZ() + 0.3 * noise.at(center)).normalized()).norm() < 1e-15);
}

// The paper: "disturbs the optical depth": its mean over the picture changes by less than 5 % at scale 0.25 and
// frequencies around one cell per Gaussian, every depth stays positive, and the picture does change.
TEST_CASE("noise disturbs depths and keeps their mean", "[fogshop]") {
  for (const char* variant : {"paper", "S"}) {
    const scene::Film plain = render("f100", {{"variant", variant}});
    for (const char* frequency : {"0.3", "1"}) {
      const scene::Film noisy =
          render("f100", {{"variant", variant}, {"noise_scale", "0.25"}, {"noise_frequency", frequency}});
      double before = 0, after = 0, difference = 0;
      for (std::size_t i = 0; i < plain.layer("transmittance").size(); ++i) {
        const double a = -std::log(plain.layer("transmittance")[i]), b = -std::log(noisy.layer("transmittance")[i]);
        before += a;
        after += b;
        difference += std::abs(b - a);
        CHECK(b >= 0);
        CHECK(std::isfinite(noisy.layer("airlight")[i]));
        CHECK(noisy.layer("airlight")[i] >= 0);
      }
      INFO(variant << " " << frequency << ": mean " << after / before - 1 << ", change " << difference / before);
      CHECK(std::abs(after / before - 1) < 0.05);
      CHECK(difference / before > 0.005);
    }
  }
}

TEST_CASE("no noise has no seed; the same bits on one thread and on two", "[fogshop]") {
  for (const char* variant : {"paper", "S"}) {
    const scene::Film plain = render("a30", {{"variant", variant}});
    for (const char* name : {"noise_seed", "noise_phase", "noise_frequency"})
      CHECK_THROWS_WITH(render("a30", {{"variant", variant}, {name, "2"}}),
                        Catch::Contains("is not read with noise_scale = 0, expected noise_scale > 0"));
    CHECK(render("a30", {{"variant", variant}, {"noise_scale", "0"}}).layers == plain.layers);
    const Pairs noisy{{"variant", variant}, {"noise_scale", "0.4"}};
    CHECK(render("a30", noisy, 1).layers == render("a30", noisy, 2).layers);
    CHECK(render("a30", noisy).layers != plain.layers);
  }
}

}  // namespace noise_test
