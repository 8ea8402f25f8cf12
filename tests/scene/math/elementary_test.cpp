#include "scene/math/elementary.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/math/random.h"

namespace elementary_test {

using namespace airlight;

namespace {

// Distance of a double from the long double truth in units of the last place of the truth.
double ulps(double value, long double truth) {
  const double rounded = double(truth);
  if (rounded == 0) return double(std::abs(value - truth) / 0x1p-1074L);
  const double ulp = std::nextafter(std::abs(rounded), infinity) - std::abs(rounded);
  return double(std::abs((long double)(value)-truth) / ulp);
}

double uniform(int i) { return SampleRandom(11, 1, 0, i).block(0, Purpose::camera).fine(0); }

}  // namespace

// Against the C library's long double functions (64 bit mantissa, error below 0.001 of our ulp).
TEST_CASE("elementary functions are within two units in the last place", "[elementary]") {
  double log_error = 0, exp_error = 0, sin_error = 0, cos_error = 0, atan_error = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double u = uniform(i), v = uniform(i + n);
    for (const double x : {u, 1 - 0x1p-20 * u, 1 + 0x1p-12 * u, std::ldexp(u, int(2000 * v) - 1000)})
      log_error = std::max(log_error, ulps(elementary::log(x), std::log((long double)(x))));
    for (const double x : {-40 * u, 1400 * u - 700, 0x1p-20 * (u - 0.5)})
      exp_error = std::max(exp_error, ulps(elementary::exp(x), std::exp((long double)(x))));
    // The argument 2 pi u is rounded: near zeros of the function the error is absolute, in ulp of 2 pi.
    const long double angle = 2 * 3.14159265358979323846264338327950288L * u;
    const auto turn = elementary::sincos_turns(u);
    sin_error = std::max(sin_error, double(std::abs(turn.sin - std::sin(angle))));
    cos_error = std::max(cos_error, double(std::abs(turn.cos - std::cos(angle))));
    for (const double s : {1.0, 1e-9, 1e9})
      for (const double sign : {1.0, -1.0})
        atan_error = std::max(atan_error, ulps(elementary::atan2(s * u, sign * v),
                                               std::atan2((long double)(s * u), (long double)(sign * v))));
  }
  CAPTURE(log_error, exp_error, sin_error, cos_error, atan_error);
  CHECK(log_error < 2);
  CHECK(exp_error < 1.5);
  CHECK(sin_error < 3e-16);
  CHECK(cos_error < 3e-16);
  CHECK(atan_error < 2);
}

TEST_CASE("elementary functions at the ends of their ranges", "[elementary]") {
  CHECK(elementary::log(1.0) == 0);
  CHECK(elementary::log(1 - 0x1p-53) == -0x1p-53);
  CHECK(elementary::log(0x1p-53) == Approx(-53 * std::log(2.0)).epsilon(1e-15));
  CHECK(elementary::exp(0.0) == 1);
  CHECK(elementary::exp(-infinity) == 0);
  CHECK(elementary::exp(-800.0) == 0);
  CHECK(elementary::exp(-740.0) == Approx(std::exp(-740.0)).epsilon(1e-2));  // subnormal: few digits
  CHECK(elementary::exp(800.0) == infinity);
  CHECK(std::isnan(elementary::exp(std::nan(""))));
  CHECK(elementary::sincos_turns(0.25).sin == 1);
  CHECK(elementary::sincos_turns(0.5).cos == -1);
  CHECK(elementary::sincos_turns(1 - 0x1p-53).sin == Approx(-2 * pi * 0x1p-53).epsilon(1e-15));
  CHECK(elementary::atan2(0.0, 0.0) == 0);
  CHECK(elementary::atan2(0.0, -1.0) == pi);
  CHECK(elementary::atan2(1.0, infinity) == 0);
  CHECK(elementary::atan2(1.0, 0.0) == pi / 2);
  CHECK(elementary::atan2(-1.0, -infinity) == -pi);
}

}  // namespace elementary_test
