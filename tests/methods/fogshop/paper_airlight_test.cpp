#include "methods/fogshop/paper_airlight.h"

#include <catch2/catch.hpp>

#include "tests/methods/fogshop/vectors.h"

namespace paper_airlight_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::relative_error;
using scene::GaussianSum;

static const Ray ray{Point3(0, 0, 0), Vec3(0, 0, 1)};

TEST_CASE("paper airlight of nothing is nothing", "[fogshop]") {
  CHECK(paper_airlight(GaussianSum{}, Point3(1, 0, 2), 1, ray, 8) == 0);
  CHECK(paper_airlight(GaussianSum{{{Point3(0, 0, 4), 1, 1}}, 0.1, infinity}, Point3(1, 0, 2), 1, ray, 0) == 0);
}

// Without Gaussians the paper's airlight is the homogeneous one: Eq. 16 gives C_sv = 1.
TEST_CASE("paper airlight of a constant medium", "[fogshop]") {
  const GaussianSum fog{{}, 0.2, infinity};
  CHECK(relative_error(paper_airlight(fog, Point3(3, 0, 4), 7, ray, 9),
                       7 * homogeneous_airlight(LightFromRay{4, 3}, 9, 0.2)) <= 1e-15);
}

// One Gaussian whose centre the ray passes through: b_i^r = b_i, all exponents but the path s -> b -> v cancel, and
// L = I0 / (4 pi |b-s|^2) y exp(-T(s,b) - T(v,b)).
TEST_CASE("paper airlight of a central Gaussian", "[fogshop]") {
  const GaussianSum fog{{{Point3(0, 0, 4), 1.25, 0.5}}, 0, infinity};
  const Point3 light(2, 0, 4);
  const double half = 0.5 * std::sqrt(pi) * 0.5 * 1.25;
  const double depth = half * (std::erf(0.8 * 4) + std::erf(0.8 * 4));
  const double expected = depth / (4 * pi * 4) * std::exp(-half * std::erf(0.8 * 2) - half * std::erf(0.8 * 4));
  CHECK(relative_error(paper_airlight(fog, light, 1, ray, 8), expected) <= 1e-14);
}

TEST_CASE("paper airlight with the light at the camera", "[fogshop]") {
  CHECK(std::isinf(paper_airlight(GaussianSum{{}, 0.5, infinity}, Point3(0, 0, 0), 1, ray, infinity)));
  // With a source radius of 1 cm, 13 digits of the stress table.
  CHECK(paper_airlight(GaussianSum{{}, 0.5, infinity}, Point3(0, 0, 0), 1, ray, infinity, {0.01, nullptr}) ==
        Approx(6.049635435552).epsilon(1e-12));
}

// A table of 256^2 in sqrt(u): F to 1.1e-4 (measured in advance on the same grid), and within that of the closed form.
TEST_CASE("the paper's table of F", "[fogshop]") {
  const FTable table(256);
  double worst = 0;
  for (int i = 0; i <= 300; ++i)
    for (int j = 0; j <= 300; ++j) {
      const double u = 10.0 * i / 300, v = 0.5 * pi * j / 300;
      worst = std::max(worst, std::abs(table.F(u, v) - F(u, v)));
    }
  CHECK(worst <= 1.2e-4);
  CHECK(worst >= 1e-6);  // it is a table
  CHECK(table.F(50, 1) == table.F(10, 1));
  const LightFromRay light{4, 3};
  CHECK(relative_error(table.homogeneous_airlight(light, 9, 0.2), homogeneous_airlight(light, 9, 0.2)) <= 1e-3);
}

}  // namespace paper_airlight_test
