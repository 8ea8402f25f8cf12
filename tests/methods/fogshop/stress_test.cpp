// Extreme inputs with answers to thirteen digits, from a table that was computed in 25-digit arithmetic.
#include <catch2/catch.hpp>

#include "tests/methods/fogshop/ray_model.h"
#include "tests/methods/fogshop/vectors.h"

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::exact;
using fogshop_test::grey_fog;
using fogshop_test::ray_airlight;
using fogshop_test::relative_error;
using scene::Gaussian;

namespace {

// a = 1/width, c = amplitude.
Gaussian gaussian(double a, double c, const Point3& b) { return {b, 1 / a, c}; }

}  // namespace

// The exact airlight of one Gaussian, by extrapolated slices.
TEST_CASE("airlight of one Gaussian, stress table", "[fogshop]") {
  struct Case {
    double a, c;
    Point3 b, light;
    double d;
    Point3 view;
    double expected;
  };
  const Point3 usual(0, 0, 4), origin(0, 0, 0);
  const Case cases[] = {
      {0.8, 0.5, usual, {0.3, 0, 4.2}, 5, usual, 0.1611462240454},
      {0.8, 5e-9, usual, {2, 2, 3}, 8, origin, 9.330471919883e-11},
      {0.8, 5000, usual, {0, 4, 1}, 8, origin, 2.78194093587e-4},
      {0.8, 0.5, usual, {1e-4, 0, 4}, 8, origin, 718.1102659714},
      {50, 40, {0, 0.01, 4}, {1, 1, 3}, 8, origin, 0.01062543614511},
      {1e-3, 0.05, usual, {2, 2, 3}, 8, origin, 0.001875333476337},
      {0.8, 0.5, usual, {0.001, 0, 8}, 8, origin, 0.00294825824928},
      {0.8, 0.5, {0, 0, -3}, {2, 2, 3}, 8, origin, 1.939165723248e-6},
  };
  // With 1024 slices what is left of K^-4 is below 4e-8; the error function, good to 1.2e-12, counts most where the
  // light sits in the far tail of the Gaussian and only a difference of two tails shines.
  Options o = exact(Options::Variant::slices, 1024);
  o.extrapolate = true;
  for (const Case& c : cases)
    for (bool boxes : {false, true}) {
      INFO(c.expected << " " << boxes);
      o.boxes = boxes;
      const Fog fog = grey_fog({{gaussian(c.a, c.c, c.b)}, 0, infinity});
      const Rgb got = ray_airlight(o, fog, c.light, Rgb::Ones(), {c.view, Vec3::UnitZ(), c.d});
      CHECK(relative_error(got[0], c.expected) <= 1e-7);
    }
}
