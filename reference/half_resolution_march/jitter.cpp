#include "reference/half_resolution_march/jitter.h"

#include <algorithm>
#include <cmath>

namespace airlight::half_resolution_march {
namespace {

double fraction(double x) { return x - std::floor(x); }

double gradient_noise(int x, int y) { return fraction(52.9829189 * fraction(0.06711056 * x + 0.00583715 * y)); }

}  // namespace

int bayer(int x, int y) {
  int value = 0;
  for (int bit = 0; bit < 3; ++bit) {
    const int i = x >> bit & 1, j = y >> bit & 1;
    value = 4 * value + 2 * (i ^ j) + j;
  }
  return value;
}

double step_offset(Jitter jitter, int x, int y, int frame) {
  if (jitter == Jitter::none) return 0.5;
  constexpr double golden = 0.6180339887498949, margin = 1e-6;
  const double first = jitter == Jitter::bayer ? (bayer(x, y) + 0.5) / 64 : gradient_noise(x, y);
  return std::clamp(fraction(first + frame * golden), margin, 1 - margin);
}

}  // namespace airlight::half_resolution_march
