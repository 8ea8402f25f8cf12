#include "scene/media/legendre_box.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/error.h"
#include "scene/media/legendre_line.h"
#include "tests/scene/media/legendre_fields.h"

namespace airlight::scene {
namespace {

using test::modular_box;
using test::random_point;

struct Segment {
  Ray ray;
  double length;
};
Segment between(const Point3& p, const Point3& q) { return {{p, (q - p).normalized()}, (q - p).norm()}; }

// By midpoints: independent of the polynomial along the ray.
double summed(const LegendreBox& field, const Segment& s, int steps) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += density(field, s.ray.at((i + 0.5) / steps * s.length));
  return sum * s.length / steps;
}

}  // namespace

// Two million random points, in boxes of all sizes, of all degrees, some of them partly outside.
TEST_CASE("bounds of Legendre boxes hold at random points", "[media][legendre]") {
  std::uint32_t index = 0;
  for (const int n : {1, 2, 4, 8, 9, 12, 24}) {
    const Box box{{-2, 0.5, -1}, {1, 1.5, 3}};
    const auto field = modular_box(n, n, 0.2, box);
    const int boxes = n > 9 ? 40 : 250, points = n > 9 ? 500 : 1500;
    for (int b = 0; b < boxes; ++b) {
      const Vec3 size = box.size() * std::pow(2.0, -double(b % 9));
      const Point3 center = box.lo + (1.2 * random_point(index, 1).array() - 0.1).matrix().cwiseProduct(box.size());
      const Box part{center - 0.5 * size, center + 0.5 * size};
      const Interval bounds = density_bounds(*field, part);
      for (int i = 0; i < points; ++i) {
        const double value = density(*field, part.lo + random_point(++index).cwiseProduct(size));
        if (!(value >= bounds.lo && value <= bounds.hi && value <= field->greatest())) {
          CAPTURE(n, b, value, bounds.lo, bounds.hi, field->greatest());
          FAIL("a density out of bounds");
        }
      }
    }
  }
  SUCCEED("none out of bounds");
}

TEST_CASE("the greatest density of a Legendre box is a per cent too great at most", "[media][legendre]") {
  for (const int n : {2, 4, 6, 8, 12}) {
    const auto field = modular_box(n, 3, 0.3);
    double most = 0;
    const int steps = 8 * n;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j)
        for (int k = 0; k <= steps; ++k)
          most = std::max(most, field->value(Point3(i, j, k) * (2.0 / steps) - Vec3::Ones()));
    CHECK(field->greatest() >= most);
    CHECK(field->greatest() <= 1.015 * most);
  }
}

TEST_CASE("integrals through Legendre boxes agree with fine sums, and add up", "[media][legendre]") {
  for (const int n : {1, 3, 6, 12}) {
    const auto field = modular_box(n, 5, n == 1 ? 1 : 0.1, {{-2, 0.5, -1}, {1, 1.5, 3}});
    for (std::uint32_t r = 0; r < 12; ++r) {
      // From outside to outside, or along an axis.
      Point3 q = Point3(-3, 0, -2) + 6 * random_point(r, 3);
      const Point3 p = Point3(-2.5, 0.2, -1.5) + 3 * random_point(r, 2);
      if (r % 4 == 0) q = p + Vec3(0, 2, 0);
      const Segment s = between(p, q);
      const double exact = density_integral(*field, s.ray, {0, s.length});
      const int steps = 20000;
      CHECK(exact == Approx(summed(*field, s, steps)).margin(3 * s.length * field->greatest() / steps));
      const double halves = density_integral(*field, s.ray, {0, 0.4 * s.length}) +
                            density_integral(*field, s.ray, {0.4 * s.length, s.length});
      CHECK(halves == Approx(exact).margin(1e-12));
    }
  }
}

// f = u^2 - 1/4: negative in the middle, along the x axis 1/2 - 5/6 + ... in closed form.
TEST_CASE("a Legendre box clamped between two roots, in closed form", "[media][legendre]") {
  // u^2 = (2 P_2 + 1) / 3; L_0 of the two other axes is 1/sqrt(2) each.
  const double other = 2;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3);
  f[0] = (1.0 / 3 - 0.25) * std::sqrt(2.0) * other;
  f[2] = 2.0 / 3 / std::sqrt(2.5) * other;
  const LegendreBox field(test::unit_box, {3, 1, 1}, f);
  CHECK(field.value({0.3, 0.1, 0.9}) == Approx(0.3 * 0.3 - 0.25).margin(1e-15));
  // Twice the integral from 1/2 to 1.
  const Ray along{{-4, 0.2, 0.3}, Vec3::UnitX()};
  CHECK(density_integral(field, along, {0, infinity}) == Approx(2 * (7.0 / 24 - 0.125)).epsilon(1e-14));
  CHECK(density_integral(field, along, {3, 4}) == Approx(7.0 / 24 - 0.125).epsilon(1e-14));
  // A face belongs to the box.
  CHECK(density(field, {1, 1, -1}) == Approx(0.75));
  CHECK(density(field, {1 + 1e-12, 1, -1}) == 0);
  CHECK(field.greatest() == Approx(0.75).epsilon(1e-12));
  const LegendreLine line(field, along, {3, 5});
  REQUIRE(line.positive().size() == 2);
  CHECK(line.positive()[0].hi == Approx(3.5).epsilon(1e-15));
  CHECK(line.positive()[1].lo == Approx(4.5).epsilon(1e-15));
}

// A square touches 0 without a change of sign, and has a root of even order there.
TEST_CASE("a Legendre box that touches zero", "[media][legendre]") {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3);
  const double shift = 0.123;  // (u - s)^2 = u^2 - 2 s u + s^2
  f[0] = (1.0 / 3 + shift * shift) * 2 * std::sqrt(2.0);
  f[1] = -2 * shift / std::sqrt(1.5) * 2;
  f[2] = 2.0 / 3 / std::sqrt(2.5) * 2;
  const LegendreBox field(test::unit_box, {3, 1, 1}, f);
  const double exact = (std::pow(1 - shift, 3) + std::pow(1 + shift, 3)) / 3;
  CHECK(density_integral(field, {{-2, 0, 0}, Vec3::UnitX()}, {0, 9}) == Approx(exact).epsilon(1e-13));
}

TEST_CASE("a Legendre box says what is wrong with it", "[media][legendre]") {
  const auto made = [](const Box& box, const TensorShape& shape, Eigen::Index count, double value) {
    return LegendreBox(box, shape, Eigen::VectorXd::Constant(count, value));
  };
  CHECK_THROWS_AS(made(test::unit_box, {0, 1, 1}, 0, 1), Error);
  CHECK_THROWS_AS(made(test::unit_box, {33, 1, 1}, 33, 1), Error);
  CHECK_THROWS_AS(made(test::unit_box, {2, 1, 1}, 3, 1), Error);
  CHECK_THROWS_AS(made(test::unit_box, {2, 1, 1}, 2, std::nan("")), Error);
  CHECK_THROWS_AS(made({{1, 0, 0}, {0, 1, 1}}, {1, 1, 1}, 1, 1), Error);
}

}  // namespace airlight::scene
