// Free flight through a medium whose extinction is linear along the way.
#pragma once
#include <algorithm>
#include <cmath>

namespace airlight::scene {

// The distance s at which the optical depth t >= 0 is reached, where the extinction goes linearly from a to b (both >=
// 0 [1/m]) over `length` [m] and t <= (a + b) length / 2. The root of a s + (b - a) s^2 / (2 length) = t in the form
// that holds for a = b, and for a = 0; 0 for t = 0.
inline double linear_flight(double a, double b, double length, double t) {
  if (!(t > 0)) return 0;
  const double discriminant = std::max(0.0, a * a + 2 * (b - a) * t / length);
  return std::min(length, 2 * t / (a + std::sqrt(discriminant)));
}

}  // namespace airlight::scene
