#include "scene/math/spherical_harmonics.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"

namespace spherical_harmonics_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

}  // namespace

// Sloan, "Stupid Spherical Harmonics Tricks", appendix A2, has these as polynomials; so have most textbooks.
TEST_CASE("spherical harmonics up to band 2 are the textbook polynomials", "[spherical_harmonics]") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 w = random_direction(random);
    const double x = w[0], y = w[1], z = w[2];
    const double c1 = std::sqrt(3 / (4 * pi)), c2 = std::sqrt(15 / (4 * pi)), c3 = std::sqrt(5 / (16 * pi));
    const double expected[] = {
        std::sqrt(1 / (4 * pi)), -c1 * y, c1 * z, -c1 * x, c2 * x * y, -c2 * y * z, c3 * (3 * z * z - 1), -c2 * x * z,
        c2 / 2 * (x * x - y * y)};
    const auto values = evaluate_sh(3, w);
    REQUIRE(values.size() == 9);
    for (int i = 0; i < 9; ++i) CHECK(values[i] == Approx(expected[i]).margin(4e-16));
  }
}

// The product rule with n = order nodes integrates products of two bands below `order` exactly: what is left is
// rounding, about 1e-16 times the square root of the number of nodes.
TEST_CASE("spherical harmonics are orthonormal", "[spherical_harmonics]") {
  for (const int order : {6, 20}) {
    const int count = order * order;
    const GaussLegendre rule = gauss_legendre(order);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count);
    for (int j = 0; j < order; ++j)
      for (int i = 0; i < 2 * order; ++i) {
        const double z = rule.node[j], s = std::sqrt(1 - z * z), phi = pi * (i + 0.25) / order;
        const auto values = evaluate_sh(order, {s * std::cos(phi), s * std::sin(phi), z});
        const Eigen::Map<const Eigen::VectorXd> y(values.data(), count);
        gram += rule.weight[j] * pi / order * y * y.transpose();
      }
    CHECK((gram - Eigen::MatrixXd::Identity(count, count)).cwiseAbs().maxCoeff() < 1e-13);
  }
}

// Sum over m of Y_lm(a) Y_lm(b) = (2l+1)/(4 pi) P_l(a.b), also at the poles and at the highest order.
TEST_CASE("spherical harmonics obey the addition theorem", "[spherical_harmonics]") {
  std::mt19937 random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 a = trial == 0 ? Vec3::UnitZ() : random_direction(random);
    const Vec3 b = trial == 1 ? Vec3(-Vec3::UnitZ()) : random_direction(random);
    const auto ya = evaluate_sh(max_sh_order, a), yb = evaluate_sh(max_sh_order, b);
    for (int l = 0; l < max_sh_order; ++l) {
      double sum = 0;
      for (int m = -l; m <= l; ++m) sum += ya[sh_index(l, m)] * yb[sh_index(l, m)];
      // P_l has slopes up to l(l+1)/2, times the rounding of a.b; each Y errs by about 1e-15 l.
      const double expected = (2 * l + 1) / (4 * pi) * std::legendre(unsigned(l), std::clamp(a.dot(b), -1.0, 1.0));
      REQUIRE(sum == Approx(expected).margin(1e-15 * (l + 1) * (l + 1)));
    }
  }
}

TEST_CASE("spherical harmonics refuse other orders", "[spherical_harmonics]") {
  CHECK_THROWS_AS(evaluate_sh(0, Vec3::UnitX()), Error);
  CHECK_THROWS_AS(evaluate_sh(-3, Vec3::UnitX()), Error);
  CHECK_THROWS_AS(evaluate_sh(max_sh_order + 1, Vec3::UnitX()), Error);
}

// x^(2k) integrates to 2/(2k+1) over [-1, 1], exactly up to degree 2n - 1.
TEST_CASE("Gauss-Legendre rules are exact for polynomials", "[spherical_harmonics]") {
  for (const int n : {1, 2, 3, 8, 33, 256}) {
    const GaussLegendre rule = gauss_legendre(n);
    for (int k = 0; 2 * k <= 2 * n - 1; ++k) {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += rule.weight[i] * std::pow(rule.node[i], 2 * k);
      REQUIRE(sum == Approx(2.0 / (2 * k + 1)).epsilon(1e-12));
    }
  }
}

}  // namespace spherical_harmonics_test
