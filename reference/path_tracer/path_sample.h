// The radiance that one path brings, kept apart by scattering order.
#pragma once
#include <array>

#include "scene/math/types.h"

namespace airlight::path_tracer {

inline constexpr int most_orders = 12;  // greatest K: order.0 .. order.K, and order.rest

// Order m = scatterings in a medium, s = reflections by surfaces.
struct PathSample {
  explicit PathSample(int orders) : K(orders) {
    for (int m = 0; m <= K + 1; ++m) order[m] = Rgb::Zero();
  }
  void add(int m, int s, const Rgb& radiance) {
    order[m <= K ? m : K + 1] += radiance;
    if (m == 0) surface += radiance;
    if (m == 1 && s == 0) airlight += radiance;
  }
  Rgb total() const {
    Rgb sum = order[0];
    for (int m = 1; m <= K + 1; ++m) sum += order[m];
    return sum;
  }

  int K;
  std::array<Rgb, most_orders + 2> order;  // [K + 1] is the rest
  Rgb airlight = Rgb::Zero();              // (m, s) = (1, 0)
  Rgb surface = Rgb::Zero();               // (0, s)
  Rgb truncated = Rgb::Zero();             // throughput that a cap on the order threw away
};

}  // namespace airlight::path_tracer
