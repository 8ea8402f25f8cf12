#include "scene/media/region.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/scene/media/random_points.h"

namespace region_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

const Interval everywhere{0, infinity};

void check_interval(Interval got, double lo, double hi) {
  CHECK(got.lo == Approx(lo).margin(1e-14));
  if (std::isinf(hi))
    CHECK(got.hi == hi);
  else
    CHECK(got.hi == Approx(hi).margin(1e-14));
}

}  // namespace

TEST_CASE("rays clipped to regions", "[media]") {
  const Ray along_z{{0, 0, -5}, Vec3::UnitZ()};
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  check_interval(clip(Unbounded{}, along_z, everywhere), 0, infinity);
  check_interval(clip(box, along_z, everywhere), 4, 6);
  check_interval(clip(box, along_z, {4.5, 5.5}), 4.5, 5.5);
  check_interval(clip(Sphere{{0, 0, 0}, 2}, along_z, everywhere), 3, 7);
  check_interval(clip(Slab{Vec3::UnitZ(), -1, 3}, along_z, everywhere), 4, 8);
  check_interval(clip(Slab{-Vec3::UnitZ(), -3, 1}, along_z, everywhere), 4, 8);
  // Behind, beside, and parallel outside.
  CHECK(clip(box, {{0, 0, 5}, Vec3::UnitZ()}, everywhere).empty());
  CHECK(clip(box, {{3, 0, -5}, Vec3::UnitZ()}, everywhere).empty());
  CHECK(clip(Sphere{}, {{3, 0, -5}, Vec3::UnitZ()}, everywhere).empty());
  CHECK(clip(Slab{}, {{0, -1, 0}, Vec3::UnitX()}, everywhere).empty());
  // Inside a slab and parallel to it there is no end.
  check_interval(clip(Slab{}, {{0, 0.5, 0}, Vec3::UnitX()}, everywhere), 0, infinity);
  // An empty range stays empty.
  CHECK(clip(Unbounded{}, along_z, {2, 2}).empty());
  CHECK(clip(box, along_z, {7, 9}).empty());
}

// Closed sets: a ray that runs in a face is inside. Minus zero counts as zero.
TEST_CASE("a ray within a face of a box", "[media]") {
  const Box box{{0, 0, 0}, {1, 1, 1}};
  for (double face : {0.0, -0.0, 1.0})
    for (double zero : {0.0, -0.0}) {
      check_interval(clip(box, {{face, 0.5, -1}, {zero, zero, 1}}, everywhere), 1, 2);
      check_interval(clip(box, {{face, face, 2}, {zero, zero, -1}}, everywhere), 1, 2);
    }
  CHECK(clip(box, {{1 + 1e-15, 0.5, -1}, Vec3::UnitZ()}, everywhere).empty());
  CHECK(contains(box, {1, 1, 1}));
  CHECK(contains(Slab{}, {7, 1, 7}));
}

// The chord of a sphere 1e8 radii away: the ray parameter is known to 1e-16 of the distance, the chord's length to
// about that over the sine of the grazing angle.
TEST_CASE("a sphere far away keeps its chord", "[media]") {
  const double far = 1e8;
  const Interval chord = clip(Sphere{{0, 0, far}, 1}, {{0.6, 0, 0}, Vec3::UnitZ()}, everywhere);
  CHECK(chord.hi - chord.lo == Approx(1.6).margin(4e-8));
  CHECK(0.5 * (chord.lo + chord.hi) == Approx(far).epsilon(1e-15));
}

// Points on the ray are in the region exactly where clip says so; within 1e-12 of an end either answer may stand.
TEST_CASE("clip and contains agree along random rays", "[media]") {
  RandomPoints random(11);
  const Vec3 tilted = Vec3(1, 2, -0.5).normalized();
  const Region regions[] = {Unbounded{}, Box{{-1, -0.5, -2}, {0.5, 1, 1}}, Sphere{{0.3, -0.2, 0.1}, 1.1},
                            Slab{tilted, -0.4, 0.7}};
  for (const Region& region : regions)
    for (int i = 0; i < 3000; ++i) {
      const Ray ray{random.in({Point3::Constant(-3), Point3::Constant(3)}), random.direction()};
      const Interval part = clip(region, ray, {0, 6});
      for (int k = 0; k < 10; ++k) {
        const double t = random.uniform(0, 6);
        if (std::abs(t - part.lo) < 1e-12 || std::abs(t - part.hi) < 1e-12) continue;
        CHECK(contains(region, ray.at(t)) == (!part.empty() && t > part.lo && t < part.hi));
        if (contains(region, ray.at(t))) CHECK(bounding_box(region).contains(ray.at(t)));
      }
    }
}

TEST_CASE("boxes around regions", "[media]") {
  CHECK(bounding_box(Unbounded{}).lo[1] == -infinity);
  const Box ball = bounding_box(Sphere{{1, 2, 3}, 2});
  CHECK(ball.lo.isApprox(Point3(-1, 0, 1), 1e-14));
  CHECK(ball.hi.isApprox(Point3(3, 4, 5), 1e-14));
  const Box slab = bounding_box(Slab{-Vec3::UnitY(), 1, 2});
  CHECK(slab.lo[1] == -2);
  CHECK(slab.hi[1] == -1);
  CHECK(slab.hi[0] == infinity);
}

}  // namespace region_test
