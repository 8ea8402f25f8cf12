// Media as Legendre boxes: polynomials come back, smooth fields come close spectrally, jumps are kept positive.
#include "scene/convert/legendre_projection.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "scene/base/error.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"
#include "tests/scene/media/legendre_fields.h"
#include "tests/temporary_folder.h"

namespace legendre_projection_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

Medium of(DensityField field, const Region& region = Unbounded{}) {
  Medium medium;
  medium.field = std::move(field);
  medium.region = region;
  return medium;
}

// 1 in a square column, in which nothing depends on z.
Medium column() { return of(Homogeneous{1}, Box{{-0.5, -0.5, -1}, {0.5, 0.5, 1}}); }

ProjectionOptions flat(int n, bool lanczos, bool limiter) {
  ProjectionOptions options;
  options.shape = {n, n, 1};
  options.box = test::unit_box;
  options.lanczos = lanczos;
  options.limiter = limiter;
  return options;
}

}  // namespace

TEST_CASE("a polynomial comes back from its projection", "[legendre][convert]") {
  const auto field = test::modular_box(4, 2, 6, {{-2, 0, 1}, {1, 2, 5}});
  REQUIRE(!field->negative());
  ProjectionOptions options;
  options.shape = {4, 5, 5};  // four points are exact up to degree 7: 3 of the field and 4
  options.lanczos = false;
  const LegendreProjection back = project_to_legendre(of(field), options);
  CHECK(back.theta == 1);
  CHECK(back.error < 1e-13);
  CHECK(back.mass_ratio == Approx(1).epsilon(1e-13));
  CHECK(back.negative_share == 0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 5; ++k) {
        const double c = j < 4 && k < 4 ? field->coefficients()[(i * 4 + j) * 4 + k] : 0;
        CHECK(std::abs(back.field->coefficients()[(i * 5 + j) * 5 + k] - c) < 1e-13);
      }
}

TEST_CASE("a Gaussian comes closer spectrally", "[legendre][convert]") {
  GaussianSum sum;
  sum.gaussians.push_back({{0.1, -0.2, 0}, 0.5, 1});
  double before = 1;
  for (const int n : {6, 10, 14, 18}) {
    ProjectionOptions options;
    options.shape = {n, n, n};
    options.box = test::unit_box;
    options.lanczos = options.limiter = false;
    options.cells = 12;
    const LegendreProjection result = project_to_legendre(of(sum), options);
    CAPTURE(n, result.error);
    CHECK(result.error < 0.2 * before);
    CHECK(result.clamped_error <= result.error);
    before = result.error;
  }
  CHECK(before < 1e-5);
}

namespace {

// The indicator of [-1/2, 1/2] in closed form: the integral of P_k is (P_{k+1} - P_{k-1}) / (2k+1).
std::vector<double> step_series(int n, bool lanczos) {
  std::vector<double> series(std::size_t(n), std::sqrt(0.5));
  for (int k = 1; k < n; ++k) {
    const auto primitive = [k](double x) {
      return (std::legendre(unsigned(k + 1), x) - std::legendre(unsigned(k - 1), x)) / (2 * k + 1);
    };
    series[std::size_t(k)] = std::sqrt(k + 0.5) * (primitive(0.5) - primitive(-0.5));
    if (lanczos) series[std::size_t(k)] *= std::sin(pi * k / n) / (pi * k / n);
  }
  return series;
}

// Error and least value of the square column from those of its two factors.
struct ColumnFigures {
  double error, least;
};
ColumnFigures column_figures(int n, bool lanczos) {
  const std::vector<double> exact = step_series(n, false), used = step_series(n, lanczos);
  double across = 0, own = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    across += exact[k] * used[k];
    own += used[k] * used[k];
  }
  double least = 0, most = 0;
  std::vector<double> values(static_cast<std::size_t>(n));
  for (int i = 0; i <= 4000; ++i) {
    legendre_values_at(n, i / 2000.0 - 1, values.data());
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k) sum += used[k] * values[k];
    least = std::min(least, sum);
    most = std::max(most, sum);
  }
  return {std::sqrt(1 - 2 * across * across + own * own), least * most};
}

}  // namespace

// Against closed forms, and the two digits of the specification, section 10, which were measured on samples.
TEST_CASE("a square column: what a jump costs, with and without Lanczos' factors", "[legendre][convert]") {
  struct Row {
    int n;
    double least, error, lanczos_least, lanczos_error;
  };
  for (const Row& row :
       {Row{4, -0.42, 0.53, -0.077, 0.61}, Row{6, -0.085, 0.41, -0.057, 0.48}, Row{8, -0.145, 0.40, -0.045, 0.44},
        Row{12, -0.085, 0.30, -0.025, 0.36}, Row{16, -0.22, 0.26, -0.022, 0.32}}) {
    for (const bool lanczos : {false, true}) {
      const LegendreProjection result = project_to_legendre(column(), flat(row.n, lanczos, false));
      const ColumnFigures expected = column_figures(row.n, lanczos);
      CAPTURE(row.n, lanczos, expected.error, expected.least);
      CHECK(result.error == Approx(expected.error).epsilon(1e-5));
      CHECK(result.values.lo <= expected.least + 1e-12);
      CHECK(result.values.lo >= 1.012 * expected.least);
      CHECK(result.error == Approx(lanczos ? row.lanczos_error : row.error).margin(0.0065));
      CHECK(expected.least == Approx(lanczos ? row.lanczos_least : row.least).margin(lanczos ? 0.0016 : 0.0051));
      CHECK(result.negative_share > 0);
      CHECK(result.mass_ratio == Approx(1).epsilon(1e-12));
    }
  }
}

TEST_CASE("the limiter leaves a positive polynomial of the same mass", "[legendre][convert]") {
  for (const int n : {4, 8, 12}) {
    const LegendreProjection free = project_to_legendre(column(), flat(n, true, false));
    const LegendreProjection limited = project_to_legendre(column(), flat(n, true, true));
    CAPTURE(n);
    CHECK(free.field->negative());
    CHECK(!limited.field->negative());
    CHECK(limited.theta < 1);
    CHECK(limited.values.lo >= 0);
    CHECK(limited.negative_share == 0);
    CHECK(limited.mass_ratio == Approx(free.mass_ratio).epsilon(1e-14));
    CHECK(limited.clamped_error == limited.error);
    // Theta of the definition, from values looked for by hand: the limiter may only be a few per cent stronger.
    double least = 1;
    for (int i = 0; i <= 200; ++i)
      for (int j = 0; j <= 200; ++j) least = std::min(least, free.field->value({i / 100.0 - 1, j / 100.0 - 1, 0}));
    CHECK(limited.theta <= 0.25 / (0.25 - least));
    CHECK(limited.theta >= 0.98 * 0.25 / (0.25 - least));
  }
}

// 1 in the half x > 0: r = 1/2 + 3/4 x, below 0 for x < -2/3, off by 1/8 in squares, of which 1/144 lies below 0.
TEST_CASE("what is below 0 of a projection, and the error without it, by hand", "[legendre][convert]") {
  ProjectionOptions options = flat(2, false, false);
  options.shape = {2, 1, 1};
  const LegendreProjection half = project_to_legendre(of(Homogeneous{1}, Box{{0, -1, -1}, {1, 1, 1}}), options);
  CHECK(half.field->value({0.4, 0.1, -0.3}) == Approx(0.5 + 0.75 * 0.4).epsilon(1e-12));
  CHECK(half.negative_share == Approx(1.0 / 6).epsilon(1e-12));
  CHECK(half.error == Approx(std::sqrt(1.0 / 8)).epsilon(1e-12));
  CHECK(half.clamped_error == Approx(std::sqrt(1.0 / 8 - 1.0 / 144)).epsilon(1e-12));
  CHECK(half.mass_ratio == Approx(1).epsilon(1e-12));
  CHECK(half.theta == 1);
}

TEST_CASE("a projection written as a file is read back bit for bit", "[legendre][convert]") {
  const TemporaryFolder folder;
  const LegendreProjection result = project_to_legendre(column(), flat(6, true, true));
  write_legendre_csv((folder.path() / "c.csv").string(), *result.field);
  const Scene scene = parse_scene(
      "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[medium]]\ntype = 'legendre'\nlo = [-1, -1, -1]\nhi = [1, 1, 1]\n"
      "size = [6, 6, 1]\nfile = 'c.csv'\n",
      "x", folder.path().string());
  const auto& field = std::get<LegendrePointer>(scene.media.at(0).field);
  for (Eigen::Index i = 0; i < 36; ++i) {
    const double c = result.field->coefficients()[i];
    CHECK(field->coefficients()[i] == (std::abs(c) < 1e-20 ? 0 : c));
  }
}

TEST_CASE("what has no projection is refused", "[legendre][convert]") {
  ProjectionOptions options;
  CHECK_THROWS_AS(project_to_legendre(of(Homogeneous{1}), options), Error);
  options.shape = {33, 1, 1};
  CHECK_THROWS_AS(project_to_legendre(column(), options), Error);
  options.shape = {2, 1, 1};
  options.cells = 0;
  CHECK_THROWS_AS(project_to_legendre(column(), options), Error);
}

}  // namespace legendre_projection_test
