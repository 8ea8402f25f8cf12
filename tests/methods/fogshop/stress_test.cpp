// Extreme inputs with answers to thirteen digits, from a table that was computed in 25-digit arithmetic.
#include <catch2/catch.hpp>

#include "tests/methods/fogshop/ray_model.h"
#include "tests/methods/fogshop/stress_cases.h"
#include "tests/methods/fogshop/vectors.h"

namespace stress_test {

using namespace airlight;
using namespace airlight::fogshop;
using fogshop_test::exact;
using fogshop_test::grey_fog;
using fogshop_test::ray_airlight;
using fogshop_test::relative_error;

// The exact airlight of one Gaussian, by extrapolated slices.
TEST_CASE("airlight of one Gaussian, stress table", "[fogshop]") {
  // With 1024 slices what is left of K^-4 is below 4e-8; the error function, good to 1.2e-12, counts most where the
  // light sits in the far tail of the Gaussian and only a difference of two tails shines.
  Options o = exact(Options::Variant::slices, 1024);
  o.extrapolate = true;
  for (const fogshop_test::StressCase& c : fogshop_test::stress_cases)
    for (bool boxes : {false, true}) {
      INFO(c.expected << " " << boxes);
      o.boxes = boxes;
      const Fog fog = grey_fog({{c.gaussian()}, 0, infinity});
      const Rgb got = ray_airlight(o, fog, c.light, Rgb::Ones(), {c.view, Vec3::UnitZ(), c.d});
      CHECK(relative_error(got[0], c.expected) <= 1e-7);
    }
}

}  // namespace stress_test
