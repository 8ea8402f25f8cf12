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

// Depth of one Gaussian along a ray in direction +z from the origin.
struct DepthCase {
  double a, c;  // 1/width, amplitude
  airlight::Point3 b;
  double d, depth;

  airlight::scene::Gaussian gaussian() const { return {b, 1 / a, c}; }
};

inline const DepthCase depth_cases[] = {
    {1, 1e6, {0, 0, 3}, 6, 1.772414696519e6},
    {1e-6, 1e6, {0, 0, 3}, airlight::infinity, 8.862299254528e11},
    {1e6, 1e6, {1e-6, 0, 3}, 6, 0.6520493321733},
    {1e6, 1, {1e-4, 0, 3}, 6, 0},  // 2e-4349
    {1e-6, 1, {0, 0, 1e6}, 1e6, 7.468241328124e5},
    {1, 1, {0, 0, -1}, airlight::infinity, 0.1394027926403},
    {1, 1, {0, 0, -26}, airlight::infinity, 5.018873596748e-296},
    {1, 1e-8, {0, 0, 3}, 6, 1.772414696519e-8},
    {1, 1, {0, 0, 3}, 1e-15, 1.234098040867e-19},
    {1, 1, {0, 0, 8}, 7.9999999, 0.8862268254528},
    {1, 0, {0, 0, 3}, 6, 0},
    {1, 1, {0, 0, 3}, 0, 0},
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
