// The point spread function of surfaces against other forms of itself, tables, and limits.
#include "methods/fogshop/surface_psf.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "methods/fogshop/average_depths.h"
#include "methods/fogshop/homogeneous_airlight.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/special_functions.h"
#include "scene/math/types.h"

namespace surface_psf_test {

using namespace airlight;
using namespace airlight::fogshop;

// The airlight that a point receives from the direction gamma, an endless ray, is that of Eq. 17: L = I/d^2 e^-T T
// NPSF.
TEST_CASE("the NPSF is the airlight of an endless ray, normalised", "[fogshop]") {
  for (const double gamma : {1e-6, 0.01, 0.3, 1.0, 1.5707963267948966, 2.5, 3.1, 3.1415})
    for (const double T : {1e-4, 0.1, 1.0, 4.0, 30.0}) {
      const double distance = 2.5, beta = T / distance;
      const double airlight = homogeneous_airlight(gamma, distance, infinity, beta);
      CAPTURE(gamma, T);
      CHECK(npsf(gamma, T) == Approx(airlight * distance * distance * std::exp(T) / T).epsilon(1e-11));
    }
}

TEST_CASE("limits of the NPSF", "[fogshop]") {
  for (const double gamma : {1e-10, 1e-8}) CHECK(npsf(gamma, 1) * 4 * gamma == Approx(1).epsilon(1e-6));
  CHECK(npsf(1e-10, 1) == Approx(2.499999996188e9).epsilon(1e-12));  // specification, section 13
  CHECK(npsf(pi, 1) == Approx(0.02207023608763).epsilon(1e-12));
  for (const double gamma : {0.1, 1.0, 3.0}) {
    CHECK(npsf(gamma, 0) == Approx((pi - gamma) / (4 * pi * std::sin(gamma))).epsilon(1e-14));
    CHECK(npsf(gamma, 1e-9) == Approx(npsf(gamma, 0)).epsilon(1e-7));
  }
}

// Specification, section 4, to the six digits printed there.
TEST_CASE("coefficients of the NPSF by depth", "[fogshop]") {
  struct Row {
    double T, g[6];
  };
  for (const Row& row : {Row{0.01, {0.672621, 0.485152, 0.387745, 0.330958, 0.293148, 0.265772}},
                         Row{0.5, {0.419803, 0.386952, 0.337236, 0.299813, 0.271719, 0.249940}},
                         Row{2, {0.246549, 0.267292, 0.255338, 0.240464, 0.226568, 0.214263}},
                         Row{10, {0.095619, 0.121587, 0.129367, 0.132049, 0.132520, 0.131872}}})
    for (int l = 0; l < 6; ++l) CHECK(npsf_coefficient(l, row.T) == Approx(row.g[l]).margin(6e-7));
  CHECK(npsf_coefficient(0, 0) == Approx(0.6960).margin(6e-5));
}

TEST_CASE("Dawson's integral", "[math]") {
  CHECK(dawson(0) == 0);
  CHECK(dawson(1) == Approx(0.53807950691276841914).epsilon(1e-14));
  CHECK(dawson(0.92413887300459176701) == Approx(0.54104422463518169847).epsilon(1e-14));  // its greatest value
  CHECK(dawson(1e-300) == Approx(1e-300).epsilon(1e-14));
  CHECK(dawson(1e200) == Approx(0.5e-200).epsilon(1e-14));
  // By quadrature of exp(s^2 - x^2), on both sides of the change of form.
  const scene::GaussLegendre rule = scene::gauss_legendre(200);
  for (const double x : {0.01, 0.5, 2.0, 5.0, 6.4999, 6.5, 6.5001, 9.0}) {
    double sum = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double s = 0.5 * x * (1 + rule.node[i]);
      sum += 0.5 * x * rule.weight[i] * std::exp((s - x) * (s + x));
    }
    CHECK(dawson(x) == Approx(sum).epsilon(1e-13));
    CHECK(dawson(-x) == -dawson(x));
  }
}

TEST_CASE("the average depth falls as the fog moves away", "[fogshop]") {
  // By the fit on vectors: one Gaussian of width 1 and amplitude 1, and several.
  const GaussianArrays one = make_arrays({{{0, 0, 0}, 1, 1}}, Cull::depth, 1e-6).arrays;
  const auto of_one = [&](double u) { return average_depth_of(one, Point3(0.6 * u, 0, 0.8 * u)); };
  std::vector<scene::Gaussian> many;
  double sum = 0;
  for (int i = 0; i < 13; ++i) {
    many.push_back({{0.3 * i, -0.2 * i, 1.7 * i}, 0.5 + 0.1 * i, 1.0 + i});
    sum += many.back().amplitude * many.back().width *
           average_depth((many.back().center - Point3(1, 2, 3)).norm() / many.back().width);
  }
  CHECK(average_depth_of(make_arrays(many, Cull::depth, 1e-6).arrays, {1, 2, 3}) == Approx(sum).epsilon(1e-8));
  double worst = 0;
  for (double u = 0; u < 1e4; u += u < 20 ? 0.00371 : 0.37 * u)
    worst = std::max(worst, std::abs(of_one(u) / average_depth(u) - 1));
  CHECK(worst < 2e-9);
  CHECK(average_depth(0) == Approx(std::sqrt(pi) / 2).epsilon(1e-15));
  CHECK(average_depth(1e6) == Approx(4.431134627266e-13).epsilon(1e-12));  // specification, section 13
  // The mean over directions of the line integrals from a point at the distance u from a Gaussian of width 1.
  const scene::GaussLegendre rule = scene::gauss_legendre(400);
  for (const double u : {0.3, 1.0, 2.5}) {
    double mean = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double m = u * rule.node[i], p2 = u * u - m * m;
      mean += 0.5 * rule.weight[i] * std::exp(-p2) * 0.5 * std::sqrt(pi) * std::erfc(-m);
    }
    CHECK(average_depth(u) == Approx(mean).epsilon(1e-12));
  }
}

}  // namespace surface_psf_test
