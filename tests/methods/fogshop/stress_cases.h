// One Gaussian, one light, one ray along +z: extreme inputs with answers to thirteen digits, computed in 25-digit
// arithmetic.
#pragma once
#include "scene/math/types.h"
#include "scene/media/gaussian_sum.h"

namespace fogshop_test {

struct StressCase {
  double a, c;  // 1/width, amplitude
  airlight::Point3 b, light;
  double d;  // length of the ray [m]
  airlight::Point3 view;
  double expected;  // airlight of 1 W/sr

  airlight::scene::Gaussian gaussian() const { return {b, 1 / a, c}; }
};

inline const StressCase stress_cases[] = {
    {0.8, 0.5, {0, 0, 4}, {0.3, 0, 4.2}, 5, {0, 0, 4}, 0.1611462240454},
    {0.8, 5e-9, {0, 0, 4}, {2, 2, 3}, 8, {0, 0, 0}, 9.330471919883e-11},
    {0.8, 5000, {0, 0, 4}, {0, 4, 1}, 8, {0, 0, 0}, 2.78194093587e-4},
    {0.8, 0.5, {0, 0, 4}, {1e-4, 0, 4}, 8, {0, 0, 0}, 718.1102659714},
    {50, 40, {0, 0.01, 4}, {1, 1, 3}, 8, {0, 0, 0}, 0.01062543614511},
    {1e-3, 0.05, {0, 0, 4}, {2, 2, 3}, 8, {0, 0, 0}, 0.001875333476337},
    {0.8, 0.5, {0, 0, 4}, {0.001, 0, 8}, 8, {0, 0, 0}, 0.00294825824928},
    {0.8, 0.5, {0, 0, -3}, {2, 2, 3}, 8, {0, 0, 0}, 1.939165723248e-6},
};

}  // namespace fogshop_test
