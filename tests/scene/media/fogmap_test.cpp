// Fogmaps: integrals against quadrature, bounds against samples, the same line in pieces and backwards.
#include "scene/media/fogmap.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scene/math/gauss_legendre.h"

namespace fogmap_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

std::vector<double> random_values(int count, unsigned seed, double empty = 0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values(count);
  for (double& value : values) value = uniform(random) < empty ? 0 : uniform(random);
  return values;
}

std::vector<HeightProfile> profiles() {
  return {SameAtAllHeights{}, Layers{{-1, 0.5, 2, 4}, {0.25, 1, 0.5, 0.125}}, ExponentialFall{0.3, 0.8}};
}

Fogmap turned_fogmap(int degree, const HeightProfile& profile) {
  Fogmap fog;
  fog.map = SplineMap(degree, {{0, 0}, {7, 5}}, random_values(35, 11 + degree));
  fog.profile = profile;
  fog.x0 = -3.1;
  fog.z0 = 2.2;
  fog.cell = 0.7;
  fog.cos_turn = std::cos(0.4);
  fog.sin_turn = std::sin(0.4);
  return fog;
}

// A ray through the map's support, from one side of its box to the other.
Ray random_ray(std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  const Point3 from(4 * u(random) - 1, 3 * u(random) + 1, 4 * u(random) + 3);
  const Point3 to(2 * u(random) - 1, 3 * u(random) + 1, 2 * u(random) + 3);
  return {from, (to - from).normalized()};
}

// By 40 points between the places where a new piece begins.
double quadrature(const Fogmap& fog, const Ray& ray, Interval t) {
  static const GaussLegendre rule = gauss_legendre(40);
  std::vector<double> cuts = smooth_between(fog, ray, t);
  cuts.insert(cuts.begin(), t.lo);
  cuts.push_back(t.hi);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double middle = 0.5 * (cuts[i] + cuts[i + 1]), half = 0.5 * (cuts[i + 1] - cuts[i]);
    for (std::size_t k = 0; k < rule.node.size(); ++k)
      sum += half * rule.weight[k] * density(fog, ray.at(middle + half * rule.node[k]));
  }
  return sum;
}

}  // namespace

TEST_CASE("fogmaps: columns equal quadrature, in pieces and backwards", "[media][fogmap]") {
  std::mt19937_64 random(5);
  for (int degree = 0; degree <= 3; ++degree)
    for (const HeightProfile& profile : profiles()) {
      const Fogmap fog = turned_fogmap(degree, profile);
      CAPTURE(degree, profile_name(profile));
      double greatest = 0;
      for (int i = 0; i < 200; ++i) {
        const Ray ray = random_ray(random);
        const double length = 12, expected = quadrature(fog, ray, {0, length});
        const double got = density_integral(fog, ray, {0, length});
        REQUIRE(got == Approx(expected).epsilon(1e-12).margin(1e-13));
        const double cut = 0.37 * length;
        REQUIRE(density_integral(fog, ray, {0, cut}) + density_integral(fog, ray, {cut, length}) ==
                Approx(got).epsilon(1e-13).margin(1e-14));
        const Ray back{ray.at(length), -ray.direction};
        REQUIRE(density_integral(fog, back, {0, length}) == Approx(got).epsilon(1e-12).margin(1e-14));
        const Interval inside = extent(fog, ray, {0, length});
        REQUIRE((inside.empty() ? 0 : density_integral(fog, ray, inside)) == Approx(got).epsilon(1e-13).margin(1e-14));
        greatest = std::max(greatest, got);
      }
      REQUIRE(greatest > 0.3);  // the rays meet the map
    }
}

TEST_CASE("fogmaps: bounds hold all samples of a box", "[media][fogmap]") {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int degree = 0; degree <= 3; ++degree)
    for (const HeightProfile& profile : profiles()) {
      const Fogmap fog = turned_fogmap(degree, profile);
      CAPTURE(degree, profile_name(profile));
      int tight = 0;
      for (int i = 0; i < 300; ++i) {
        const Point3 lo(-4 + 6 * uniform(random), -2 + 5 * uniform(random), 6 * uniform(random));
        const Box box{lo, lo + Vec3(uniform(random), uniform(random), uniform(random)) * 1.5};
        const Interval bounds = density_bounds(fog, box);
        double most = 0;
        for (int k = 0; k < 64; ++k) {
          const Point3 x = lo + Vec3(uniform(random), uniform(random), uniform(random)).cwiseProduct(box.size());
          const double value = density(fog, x);
          REQUIRE(value >= bounds.lo);
          REQUIRE(value <= bounds.hi);
          most = std::max(most, value);
        }
        tight += most > 0.3 * bounds.hi;
      }
      CHECK(tight > 100);
      const Box far{Point3(100, 0, 100), Point3(101, 1, 101)};
      REQUIRE(density_bounds(fog, far).hi == 0);
    }
}

TEST_CASE("fogmaps: upright rays, edges and endless heights", "[media][fogmap]") {
  Fogmap fog;
  fog.map = SplineMap(1, {{0, 0}, {3, 3}}, std::vector<double>(9, 1));
  fog.profile = ExponentialFall{1, 0.5};
  const Ray up{{2, 0, 2}, Vec3::UnitY()};
  CHECK(density_integral(fog, up, {0, infinity}) == Approx(1 + 0.5).epsilon(1e-14));
  CHECK(std::isinf(density_integral(fog, {{2, 0, 2}, -Vec3::UnitY()}, {0, infinity})));
  CHECK(density_integral(fog, {{20, 0, 2}, -Vec3::UnitY()}, {0, infinity}) == 0);
  // 2000 scale heights down, seen from above: only the end weighs.
  CHECK(density_integral(fog, {{2, 1001, 2}, -Vec3::UnitY()}, {0, 1000}) == Approx(0.5).epsilon(1e-13));
  // Parts of a ray shorter than rounding, at a knot: no 0 / 0.
  fog.profile = Layers{{0, 1}, {1, 0.5}};
  const Ray slanted{{1.5, 1 - 1e-9, 1.5}, Vec3(0.6, 1e-9, 0.8).normalized()};
  for (double t = 1; t < 1 + 1e-13; t += 1e-15) CHECK(density_integral(fog, slanted, {t, t + 4e-16}) >= 0);
  // Along a grid line, and exactly on the border: degree 0 belongs to the cell above.
  fog.map = SplineMap(0, {{0, 0}, {2, 2}}, {1, 2, 4, 8});
  fog.profile = SameAtAllHeights{};
  CHECK(density_integral(fog, {{1, 0, -1}, Vec3::UnitZ()}, {0, 10}) == 2 + 8);
  CHECK(density_integral(fog, {{2, 0, -1}, Vec3::UnitZ()}, {0, 10}) == 0);
  CHECK(density(fog, {2, 0, 1}) == 0);
  CHECK(density_integral(fog, {{1, 0, 1}, Vec3::UnitX()}, {0, 0}) == 0);
}

}  // namespace fogmap_test
