#include "scene/math/legendre.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/math/legendre_range.h"
#include "scene/math/legendre_series.h"
#include "tests/oracle_vectors.h"

namespace airlight::scene {
namespace {

using test::json;

std::vector<json> vectors(const char* kind) { return test::vectors_of("legendre_fluids", kind); }

double largest_difference(const Eigen::MatrixXd& a, const json& b) {
  REQUIRE(a.rows() == Eigen::Index(b.size()));
  REQUIRE(a.cols() == Eigen::Index(b[0].size()));
  double most = 0;
  for (Eigen::Index r = 0; r < a.rows(); ++r)
    for (Eigen::Index c = 0; c < a.cols(); ++c)
      most = std::max(most, std::abs(a(r, c) - test::number(b[std::size_t(r)][std::size_t(c)])));
  return most;
}

std::pair<Eigen::VectorXd, TensorShape> tensor(const json& v) {
  const test::Tensor all(v);
  return {all.array(), all.shape};
}

}  // namespace

TEST_CASE("matrices of the Legendre basis agree with 40 digits", "[legendre]") {
  CHECK(largest_difference(legendre_derivative(8), vectors("derivative")[0]["D[k][i]"]) < 1e-14);
  CHECK(largest_difference(legendre_integral(8), vectors("integral")[0]["B[k][i]"]) < 1e-15);
  CHECK(largest_difference(chebyshev_truncation(4), vectors("truncation")[0]["T"]) < 1e-14);
  const json triples = vectors("triple")[0]["entries"], counts = vectors("triple-count")[0]["entries"];
  CHECK(triples.size() > 10);
  for (const json& e : triples) {
    const double value = test::number(e["TI"]);
    CHECK(std::abs(legendre_triple(e["i"], e["j"], e["k"]) - value) <= 1e-14);
  }
  for (const json& e : counts) {
    const int n = e["n"];
    int found = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) found += legendre_triple(i, j, k) != 0;
    CHECK(found == e["nonzero"]);
  }
}

TEST_CASE("Legendre triple products stay finite up to degree 200", "[legendre]") {
  // L_0 is constant: the product with it is the inner product.
  for (const int k : {1, 50, 200}) CHECK(legendre_triple(0, k, k) == Approx(std::sqrt(0.5)).epsilon(1e-13));
  CHECK(std::isfinite(legendre_triple(200, 200, 200)));
}

TEST_CASE("the Legendre basis is orthonormal, and its matrices are its slopes and integrals", "[legendre]") {
  for (const int n : {1, 2, 7, 24, 32}) {
    const LegendrePoints points(n, n);
    CHECK((points.analysis * points.values - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() < 2e-14);
    // The slope of the integral is the function.
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(9, -1, 1);
    const Eigen::MatrixXd back = legendre_slopes(n + 1, x) * legendre_integral(n);
    CHECK((back - legendre_values(n, x)).cwiseAbs().maxCoeff() < 1e-13 * n * n);
    CHECK((legendre_values(n + 1, Eigen::VectorXd::Constant(1, -1)) * legendre_integral(n)).cwiseAbs().maxCoeff() <
          1e-14);
  }
  for (int k = 0; k < 12; ++k) {
    std::vector<double> values(12);
    legendre_values_at(12, 0.37, values.data());
    CHECK(values[std::size_t(k)] == Approx(std::sqrt(k + 0.5) * std::legendre(unsigned(k), 0.37)).epsilon(1e-13));
  }
}

TEST_CASE("products of Legendre fields agree with 40 digits in one, two and three dimensions", "[legendre]") {
  for (const json& v : vectors("product")) {
    if (!v.contains("H")) continue;
    const auto [f, f_shape] = tensor(v["F"]);
    const auto [g, g_shape] = tensor(v["G"]);
    const auto [h, h_shape] = tensor(v["H"]);
    const int d = v["d"];
    CHECK((legendre_product(f, f_shape, g, g_shape, h_shape, d) - h).cwiseAbs().maxCoeff() < 1e-14);
    // The Galerkin product is its first coefficients.
    const Eigen::VectorXd cut = legendre_product(f, f_shape, g, g_shape, f_shape, d);
    for (int i = 0; i < f_shape[0]; ++i)
      for (int j = 0; j < f_shape[1]; ++j)
        for (int k = 0; k < f_shape[2]; ++k)
          CHECK(std::abs(cut[(i * f_shape[1] + j) * f_shape[2] + k] - h[(i * h_shape[1] + j) * h_shape[2] + k]) <
                1e-14);
    std::array<Eigen::MatrixXd, 3> t;
    for (std::size_t axis = 0; axis < 3; ++axis)
      t[axis] = int(axis) < d ? chebyshev_truncation(f_shape[axis]) : Eigen::MatrixXd::Ones(1, 1);
    const auto [expected, shape] = tensor(v["H_trunc_cheb"]);
    CHECK((along_axes(t[0], t[1], t[2], h, h_shape) - expected).cwiseAbs().maxCoeff() < 1e-13);
  }
}

// Different matrices on every axis and different lengths: a swapped axis fails.
TEST_CASE("matrices are applied along their own axis", "[legendre]") {
  const TensorShape shape = {2, 3, 4};
  const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(24, -1, 2).array().sin();
  const Eigen::MatrixXd x = Eigen::MatrixXd::Random(3, 2), y = Eigen::MatrixXd::Random(5, 3),
                        z = Eigen::MatrixXd::Random(2, 4);
  const Eigen::VectorXd all = along_axes(x, y, z, f, shape);
  REQUIRE(all.size() == 30);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 5; ++b)
      for (int c = 0; c < 2; ++c) {
        double sum = 0;
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 4; ++k) sum += x(a, i) * y(b, j) * z(c, k) * f[(i * 3 + j) * 4 + k];
        CHECK(all[(a * 5 + b) * 2 + c] == Approx(sum).margin(1e-14));
      }
}

TEST_CASE("series in one variable do what the matrices do", "[legendre]") {
  for (const int n : {1, 2, 9, 64}) {
    const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(n, 0.5, 9).array().cos();
    CHECK((series_slope(f) - legendre_derivative(n) * f).cwiseAbs().maxCoeff() <= 1e-13 * n * n * n);
    CHECK((series_primitive(f) - legendre_integral(n) * f).cwiseAbs().maxCoeff() < 1e-15);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(7, -1, 1);
    const Eigen::VectorXd values = legendre_values(n, x) * f;
    for (int i = 0; i < 7; ++i) {
      CHECK(series_value(f, x[i]) == Approx(values[i]).margin(1e-13 * n));
      const bool upper = x[i] > 0;
      CHECK(series_value(series_half(f, upper), 2 * x[i] + (upper ? -1 : 1)) == Approx(values[i]).margin(1e-12 * n));
    }
  }
}

// At 2000 places of each part, degrees to both sides of where the hull ends.
TEST_CASE("ranges of Legendre series hold, and shrink onto the values", "[legendre]") {
  for (const int n : {1, 3, 8, 9, 30}) {
    const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(n, 1, 25).array().sin();
    for (const double lo : {-1.0, -0.3, 0.97}) {
      for (const double width : {0.02, 0.3}) {
        const double hi = std::min(1.0, lo + width);
        const Interval range = legendre_range(legendre_restriction(n, lo, hi) * f, {n, 1, 1}, 1);
        Interval seen;
        for (int i = 0; i <= 2000; ++i) {
          const double value = series_value(f, lo + (hi - lo) * i / 2000);
          seen = {std::min(seen.lo, value), std::max(seen.hi, value)};
        }
        CAPTURE(n, lo, hi);
        CHECK(range.lo <= seen.lo + 1e-12);
        CHECK(range.hi >= seen.hi - 1e-12);
        if (width < 0.1) CHECK(range.length() <= 1.5 * (seen.hi - seen.lo) + 1e-9);
      }
    }
  }
}

}  // namespace airlight::scene
