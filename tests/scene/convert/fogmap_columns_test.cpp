// Columns of a medium over the ground, and the fogmap made of them.
#include "scene/convert/fogmap_columns.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/types.h"

namespace fogmap_columns_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

// exp(-|x|^2), cut at 4 widths, where it is 1e-7.
DensityField ball() {
  GaussianSum sum;
  sum.gaussians.push_back({Point3(0.3, 2, -0.1), 1, 1});
  sum.cutoff = 4;
  return sum;
}

}  // namespace

TEST_CASE("columns of a Gaussian are its closed form", "[fogmap][convert]") {
  const GroundPixels pixels{5, 4, 0.6, -1, -1.2};
  const std::vector<double> columns = column_densities(ball(), pixels, 1);
  REQUIRE(columns.size() == 20);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) {
      const double x = -1 + (i + 0.5) * 0.6 - 0.3, z = -1.2 + (j + 0.5) * 0.6 + 0.1;
      CAPTURE(i, j);
      CHECK(columns[std::size_t(j) * 5 + i] == Approx(std::sqrt(pi) * std::exp(-x * x - z * z)).epsilon(1e-6));
    }
}

TEST_CASE("pixels cover the field's box", "[fogmap][convert]") {
  const DensityField field = ball();
  const Box box = varied_support(field);
  for (const int longer : {1, 7, 64}) {
    const GroundPixels p = ground_pixels(field, longer);
    CHECK(std::max(p.width, p.height) == longer);
    CHECK(p.x0 <= box.lo[0] + 1e-9);
    CHECK(p.z0 <= box.lo[2] + 1e-9);
    CHECK(p.x0 + p.width * p.cell >= box.hi[0] - 1e-9);
    CHECK(p.z0 + p.height * p.cell >= box.hi[2] - 1e-9);
  }
}

TEST_CASE("a fogmap of columns has their sum, and comes closer with the square of the pixels", "[fogmap][convert]") {
  const DensityField field = ball();
  for (const int degree : {1, 2, 3}) {
    const ColumnFogmap coarse = fogmap_from_columns(field, ground_pixels(field, 24), 4, degree);
    const ColumnFogmap fine = fogmap_from_columns(field, ground_pixels(field, 48), 4, degree);
    CAPTURE(degree);
    CHECK(fine.column_ratio == Approx(1).epsilon(1e-3));
    CHECK(fine.column_error < 0.3 * coarse.column_error);
    CHECK(fine.column_error > 0.2 * coarse.column_error);
    // The height is lost: of exp(-y^2) over 8 widths the mean is left.
    const double lost = std::sqrt(1 - std::sqrt(2 * pi) / 8);
    CHECK(fine.density_error == Approx(lost).epsilon(0.02));
  }
}

TEST_CASE("a medium without an end has no columns", "[fogmap][convert]") {
  CHECK_THROWS_AS(column_densities(Homogeneous{}, {}, 1), Error);
  GaussianSum sum;
  sum.gaussians.push_back({});
  sum.constant = 0.5;
  CHECK_THROWS_AS(ground_pixels(sum, 8), Error);
}

}  // namespace fogmap_columns_test
