#include "scene/media/gaussian_sum.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>

#include "tests/scene/media/random_points.h"

namespace gaussian_sum_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

const Box arena{Point3::Constant(-2), Point3::Constant(2)};

GaussianSum random_sum(RandomPoints& random, int n, double least_amplitude, double constant, double cutoff = infinity) {
  GaussianSum sum;
  sum.constant = constant;
  sum.cutoff = cutoff;
  for (int i = 0; i < n; ++i)
    sum.gaussians.push_back(
        {random.in(arena), std::pow(10.0, random.uniform(-1, 0.3)), random.uniform(least_amplitude, 2)});
  return sum;
}

double naive_density(const GaussianSum& sum, const Point3& x) {
  double value = sum.constant;
  for (const Gaussian& g : sum.gaussians) {
    const double widths = (x - g.center).norm() / g.width;
    if (widths < sum.cutoff) value += g.amplitude * std::exp(-widths * widths);
  }
  return std::max(0.0, value);
}

}  // namespace

TEST_CASE("density of a sum of Gaussians is its definition", "[media]") {
  RandomPoints random(1);
  for (double cutoff : {infinity, 1.5})
    for (int n : {0, 1, 3, 8, 21}) {
      const GaussianSum sum = random_sum(random, n, -1, 0.1, cutoff);
      for (int i = 0; i < 500; ++i) {
        const Point3 x = random.in(arena);
        // Rounding: n + 1 terms of at most 2, each to a few units of 1e-16 times its exponent (up to 40 where it
        // counts).
        CHECK(std::abs(density(sum, x) - naive_density(sum, x)) <= 1e-14 * (n + 1));
      }
    }
}

TEST_CASE("a Gaussian from end to end is sqrt(pi) amplitude width deep", "[media]") {
  const GaussianSum sum{{{{0, 0, 4}, 0.5, 3}}};
  CHECK(density_integral(sum, {{0, 0, -1e3}, Vec3::UnitZ()}, {0, infinity}) ==
        Approx(std::sqrt(pi) * 1.5).epsilon(3e-15));
  // Beside the axis by b: exp(-b^2/width^2) of it.
  CHECK(density_integral(sum, {{0.75, 0, -1e3}, Vec3::UnitZ()}, {-infinity, infinity}) ==
        Approx(std::sqrt(pi) * 1.5 * std::exp(-2.25)).epsilon(3e-15));
}

// Spike: the depth is amplitude sqrt(pi) width. Flat: it is amplitude times the length to e = (10/1e6)^2 = 1e-10.
TEST_CASE("stress 25: a spike and a flat Gaussian", "[media]") {
  const Ray ray{{0, 0, -5}, Vec3::UnitZ()};
  CHECK(density_integral({{{{0, 0, 0}, 1e-6, 2}}}, ray, {0, 10}) == Approx(2e-6 * std::sqrt(pi)).epsilon(1e-14));
  CHECK(density_integral({{{{0, 0, 0}, 1e6, 2}}}, ray, {0, 10}) == Approx(20).epsilon(1e-10));
  CHECK(density({{{{0, 0, 0}, 1e6, 2}}}, {3, 4, 5}) == Approx(2).epsilon(1e-10));
  // Both at once, and seen from beside the spike: nothing of it.
  CHECK(density_integral({{{{0, 0, 0}, 1e-6, 2}}}, {{1e-3, 0, -5}, Vec3::UnitZ()}, {0, 10}) == 0);
}

// Against adaptive quadrature of the density itself, cut at every cutoff sphere by leaving adaptivity to find the
// jumps: a jump of height 2 located by 40 halvings of 6 m is known to 1e-11.
TEST_CASE("line integrals of sums against quadrature", "[media]") {
  RandomPoints random(2);
  struct Kind {
    double least, constant, cutoff, tolerance;
  };
  // The last two go negative: max(0, f) has kinks, and jumps with a cutoff.
  for (const Kind& kind : {Kind{0, 0, infinity, 1e-11}, Kind{0, 0.3, infinity, 1e-11}, Kind{0, 0.1, 1.5, 1e-9},
                           Kind{-2, 0.2, infinity, 1e-10}, Kind{-2, 0.2, 1.5, 1e-9}}) {
    for (int i = 0; i < 25; ++i) {
      const GaussianSum sum = random_sum(random, 1 + i % 9, kind.least, kind.constant, kind.cutoff);
      const Ray ray{random.in(arena), random.direction()};
      const double lo = random.uniform(-1, 1), hi = lo + random.uniform(0, 5);
      const auto along = [&](double t) { return naive_density(sum, ray.at(t)); };
      const double expected = adaptive_integral(along, lo, hi, 1e-12);
      INFO(kind.least << " " << kind.constant << " " << kind.cutoff << " case " << i);
      CHECK(std::abs(density_integral(sum, ray, {lo, hi}) - expected) <= kind.tolerance);
    }
  }
}

// Additivity to rounding: the parts are the same closed form with other ends; with negative amplitudes the roots are
// found again from other pieces (3e-14 of the sum of all terms, here at most 20 over 10 m).
TEST_CASE("the integral over a segment is the sum over its parts", "[media]") {
  RandomPoints random(3);
  for (double least : {0.0, -2.0})
    for (double cutoff : {infinity, 2.0})
      for (int i = 0; i < 100; ++i) {
        const GaussianSum sum = random_sum(random, 10, least, 0.05, cutoff);
        const Ray ray{random.in(arena), random.direction()};
        double cuts[4] = {0, random.uniform(0, 3), random.uniform(3, 3.001), 10};
        double parts = 0;
        for (int k = 0; k < 3; ++k) parts += density_integral(sum, ray, {cuts[k], cuts[k + 1]});
        CHECK(std::abs(parts - density_integral(sum, ray, {0, 10})) <= (least < 0 ? 1e-11 : 4e-14));
      }
}

TEST_CASE("infinite and empty ranges of a sum", "[media]") {
  RandomPoints random(4);
  const Ray ray{{0.1, 0.2, 0.3}, Vec3(1, 2, 3).normalized()};
  for (double least : {0.1, -2.0}) {
    GaussianSum sum = random_sum(random, 12, least, 0);
    CHECK(density_integral(sum, ray, {0, infinity}) == Approx(density_integral(sum, ray, {0, 1e4})).epsilon(1e-12));
    CHECK(density_integral(sum, ray, {2, 2}) == 0);
    CHECK(density_integral(sum, ray, {}) == 0);
    sum.constant = 0.01;
    CHECK(density_integral(sum, ray, {0, infinity}) == infinity);
  }
  CHECK(density_integral(GaussianSum{}, ray, {0, infinity}) == 0);
  CHECK(density_integral(GaussianSum{{}, 0.5, infinity}, ray, {1, 4}) == 1.5);
}

// A negative Gaussian that hollows a positive one: f = exp(-t^2) - c exp(-t^2) with c = 1 vanishes, c = 2 is negative
// everywhere, and over a constant the hole's edge is where exp(-t^2) = constant.
TEST_CASE("clamped sums with known zeros", "[media]") {
  const Ray axis{{0, 0, -10}, Vec3::UnitZ()};
  const Gaussian one{Point3::Zero(), 1, 1};
  CHECK(density_integral({{one, {Point3::Zero(), 1, -1}}}, axis, {0, 20}) <= 1e-14);
  CHECK(density_integral({{one, {Point3::Zero(), 1, -2}}}, axis, {0, 20}) == 0);
  CHECK(density({{one, {Point3::Zero(), 1, -2}}}, Point3::Zero()) == 0);
  // max(0, b - exp(-t^2)): zero within |t| < r = sqrt(-ln b); integral 2 (b (10 - r) - sqrt(pi)/2 (erfc(r) -
  // erfc(10))).
  const double b = 0.25, r = std::sqrt(-std::log(b));
  const double expected = 2 * (b * (10 - r) - 0.5 * std::sqrt(pi) * std::erfc(r));
  CHECK(density_integral({{{Point3::Zero(), 1, -1}}, b, infinity}, axis, {0, 20}) == Approx(expected).epsilon(1e-12));
}

TEST_CASE("coincident Gaussians equal one with the summed amplitude", "[media]") {
  const Ray ray{{0.3, 0.1, -3}, Vec3(0.1, 0, 1).normalized()};
  GaussianSum many{std::vector<Gaussian>(8, {{0, 0.2, 0.1}, 0.7, 0.5})};
  const GaussianSum one{{{{0, 0.2, 0.1}, 0.7, 4}}};
  CHECK(density_integral(many, ray, {0, 5}) == Approx(density_integral(one, ray, {0, 5})).epsilon(2e-15));
  CHECK(density(many, {0.1, 0.2, 0.3}) == Approx(density(one, {0.1, 0.2, 0.3})).epsilon(2e-15));
}

// Every operation is a product, a quotient or a sum of lengths with one exponent: 2^k changes exponents only.
TEST_CASE("scaling by a power of two is bit-identical: Gaussians", "[media]") {
  RandomPoints random(5);
  for (double scale : {0x1p-13, 0x1p20}) {
    for (double least : {0.0, -1.0}) {
      const GaussianSum sum = random_sum(random, 7, least, 0.1);
      GaussianSum scaled = sum;
      for (Gaussian& g : scaled.gaussians) {
        g.center *= scale;
        g.width *= scale;
      }
      for (int i = 0; i < 20; ++i) {
        const Ray ray{random.in(arena), random.direction()};
        const Ray scaled_ray{scale * ray.origin, ray.direction};
        CHECK(density(scaled, scaled_ray.origin) == density(sum, ray.origin));
        CHECK(density_integral(scaled, scaled_ray, {0.5 * scale, 3 * scale}) ==
              scale * density_integral(sum, ray, {0.5, 3}));
      }
    }
  }
}

TEST_CASE("bounds of sums of Gaussians hold under random probing", "[media]") {
  RandomPoints random(6);
  int tight = 0, total = 0;
  for (double least : {0.0, -2.0})
    for (double cutoff : {infinity, 1.3})
      for (int i = 0; i < 400; ++i) {
        const GaussianSum sum = random_sum(random, 1 + i % 12, least, i % 2 ? 0.2 : 0, cutoff);
        const Box box = random.box(arena);
        const Interval bounds = density_bounds(sum, box);
        CHECK(bounds.lo >= 0);
        for (int k = 0; k < 60; ++k) {
          Point3 x = random.in(box);
          // Corners and faces are where bounds are met.
          for (int axis = 0; axis < 3; ++axis) {
            const double u = random.uniform(0, 3);
            if (u < 1) x[axis] = u < 0.5 ? box.lo[axis] : box.hi[axis];
          }
          const double value = density(sum, x);
          CHECK(value >= bounds.lo);
          CHECK(value <= bounds.hi);
        }
        if (cutoff == infinity && box.size().maxCoeff() < 1e-3) {
          ++total;
          tight += bounds.hi - bounds.lo <= 0.1 * (bounds.hi + 1e-3);
        }
      }
  // Small boxes have narrow bounds: the gap falls with the size (gradients are below 12 * 2 / 0.1 per metre).
  CHECK(total > 50);
  CHECK(tight == total);
}

// Stress 26: one pass over the Gaussians, so that ten times as many take about ten times as long; slower memory may
// cost a factor of three more. A quadratic term would show as a hundred times. Processor time, best of five.
TEST_CASE("stress 26: 1e5 Gaussians in one cell", "[media]") {
  RandomPoints random(7);
  const Box cell{Point3::Zero(), Point3::Constant(0.1)};
  const auto seconds = [&](int n, Interval& bounds, double& greatest, double& integral) {
    GaussianSum sum;
    for (int i = 0; i < n; ++i) sum.gaussians.push_back({random.in(cell), 0.05, 1.0 / n});
    double best = infinity;
    for (int repeat = 0; repeat < 5; ++repeat) {
      const std::clock_t begin = std::clock();
      bounds = density_bounds(sum, cell);
      greatest = 0;
      for (int i = 0; i < 8; ++i) greatest = std::max(greatest, density(sum, random.in(cell)));
      integral = density_integral(sum, {{0.05, 0.05, -1}, Vec3::UnitZ()}, {0, infinity});
      best = std::min(best, double(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return best;
  };
  Interval bounds;
  double greatest, integral;
  const double small = seconds(10000, bounds, greatest, integral);
  const double large = seconds(100000, bounds, greatest, integral);
  CHECK(greatest <= bounds.hi);
  CHECK(greatest > 0.1);
  // The mean over centres of exp(-d^2/w^2) sqrt(pi) w, d the distance in x and y from the middle:
  // (integral over [-1, 1] of exp(-s^2) ds / 2)^2. Standard error 1e-3 (spread 0.2 of the mean over sqrt(1e5)): 5 of
  // them.
  const double side = 0.5 * std::sqrt(pi) * std::erf(1.0);
  CHECK(integral == Approx(side * side * std::sqrt(pi) * 0.05).epsilon(5e-3));
  CHECK(large < 50 * small);
}

// Stress 2: a million far away, total depth 1e-4: the sum of single ones, each too small to see.
TEST_CASE("stress 2: the sum of many thin Gaussians", "[media]") {
  RandomPoints random(8);
  GaussianSum sum;
  const int n = 100000;
  double expected = 0, carry = 0;
  const Ray ray{Point3::Zero(), Vec3::UnitZ()};
  for (int i = 0; i < n; ++i) {
    sum.gaussians.push_back({random.in({{-3, -3, 1000}, {3, 3, 1010}}), 1, 1e-9});
    const double term = line_integral(sum.gaussians.back(), ray, infinity) - carry;  // Kahan
    const double next = expected + term;
    carry = (next - expected) - term;
    expected = next;
  }
  CHECK(density_integral(sum, ray, {0, infinity}) == Approx(expected).epsilon(1e-13));
}

TEST_CASE("support of a sum", "[media]") {
  const GaussianSum sum{{{{1, 2, 3}, 0.5, 2}, {{-1, 0, 0}, 0.25, 1}}};
  const Box box = support(sum);
  // Just outside it every Gaussian is below 1e-17 of its amplitude.
  CHECK(density(sum, {box.hi[0] * (1 + 1e-12), 2, 3}) <= 2e-17);
  CHECK(box.lo[0] == Approx(-1 - 0.25 * 6.257));
  GaussianSum cut = sum;
  cut.cutoff = 2;
  CHECK(support(cut).hi[1] == Approx(3));
  CHECK(support(GaussianSum{}).empty());
}

}  // namespace gaussian_sum_test
