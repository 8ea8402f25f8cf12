#include "scene/math/exponential_integral.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace exponential_integral_test {

using airlight::scene::scaled_exponential_integral;

// Expected values: 40-digit arithmetic, rounded to 17 digits. Both sides of the switch from series to fraction at
// |z| = 2, both axes, and imaginary parts far below the real ones. The header promises 1e-13 of each part.
TEST_CASE("scaled exponential integral against 40-digit values", "[fogshop]") {
  struct Case {
    double x, y, re, im;
  };
  const Case cases[] = {
      {0, -1e-12, 27.053805451028586, 1.5707963267668428},
      {0, -0.5, 0.67269179286854911, 0.86052676572615856},
      {0, -1.9999, 0.14455540146577132, 0.39903544362940021},
      {0, -2.0001, 0.14453520566344047, 0.39900653456875757},
      {0, -7.5, 0.016305124955871761, 0.12930185331814712},
      {0, -40, 0.00062268481026555851, 0.02496898012626847},
      {0, -1000000.0, 9.99999999994e-13, 9.99999999998e-7},
      {1e-09, -1e-09, 19.79947660334978, 0.78539814338336987},
      {1e-09, -3, 0.079221521243585565, 0.29195771065070315},
      {0.3, -0.2, 1.0772124580108168, 0.35400812488882861},
      {1.9, -0.3, 0.37018322723560423, 0.044432126555814184},
      {2.1, -0.3, 0.34362412867351056, 0.037937974211479561},
      {1.2, -1.7, 0.27343009904268519, 0.25094897993978776},
      {1.5, -1.0, 0.36092332592398575, 0.17187648733697566},
      {2, -2, 0.22879818347191401, 0.16968406001055812},
      {4, -1e-09, 0.20634564990105583, 4.365435009894417e-11},
      {0.5, -1e-12, 0.92291063248373047, 1.0770893675162695e-12},
      {1.99, -1e-14, 0.36272092036098217, 1.3979164245308818e-15},
      {7, -0.01, 0.12664088647116693, 0.00016216019467435655},
      {3, -30, 0.0043510355346061654, 0.032719274829455813},
      {25, -1, 0.03845743507901011, 0.0014830876138800064},
      {700, -3, 0.0014265102915274575, 6.1049189985674415e-6},
      {100000.0, -1e-08, 9.99990000199994e-6, 9.9998000059997602e-19},
  };
  for (const Case& c : cases) {
    INFO("z = " << c.x << " + i " << c.y);
    const auto value = scaled_exponential_integral({c.x, c.y});
    CHECK(std::abs(value.real() - c.re) <= 1e-13 * std::abs(c.re));
    CHECK(std::abs(value.imag() - c.im) <= 1e-13 * std::abs(c.im));
    // E1(conj z) = conj E1(z).
    const auto mirrored = scaled_exponential_integral({c.x, -c.y});
    CHECK(mirrored.real() == value.real());
    CHECK(mirrored.imag() == -value.imag());
  }
}

TEST_CASE("scaled exponential integral far out is 1/z", "[fogshop]") {
  const auto value = scaled_exponential_integral({3e200, -4e200});
  CHECK(value.real() == Approx(0.12e-200).epsilon(1e-15));
  CHECK(value.imag() == Approx(0.16e-200).epsilon(1e-15));
}

// The depth of the fraction was undefined: found by the fuzzer, with sanitizers.
TEST_CASE("scaled exponential integral of what is no number is none", "[fogshop]") {
  const double nan = std::nan("");
  for (const std::complex<double> z : {std::complex<double>(nan, 1), {1, nan}, {nan, nan}})
    CHECK(std::isnan(scaled_exponential_integral(z).imag()));
}

}  // namespace exponential_integral_test
