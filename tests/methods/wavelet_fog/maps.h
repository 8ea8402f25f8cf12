// Maps and rays that the tests of the method share.
#pragma once
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "methods/wavelet_fog/decomposition.h"
#include "scene/media/spline_map.h"

namespace airlight::test {

enum class Kind { smooth, patchy, hard, random };

// Coefficients in [0, 1]: hills everywhere; hills between ground without fog; fields with steep rims; each by itself.
inline wavelet_fog::Coefficients map_of(Kind kind, int width, int height, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  const double phase = 6 * uniform(random);
  wavelet_fog::Coefficients c{{{0, 0}, {width, height}}, std::vector<double>(std::size_t(width) * height)};
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      double& value = c.values[std::size_t(j) * width + i];
      const double hills = std::sin(0.23 * i + phase) * std::sin(0.19 * j + 2 * phase);
      switch (kind) {
        case Kind::smooth:
          value = 0.5 + 0.25 * hills + 0.2 * std::sin(0.05 * (i + 2 * j) + phase);
          break;
        case Kind::patchy:
          value = std::max(0.0, hills - 0.3) * (0.7 + 0.3 * uniform(random));
          break;
        case Kind::hard:
          value = hills > 0.5 ? 1 : 0;
          break;
        case Kind::random:
          value = uniform(random);
      }
    }
  return c;
}

inline scene::SplineMap spline_map(int degree, const wavelet_fog::Coefficients& c) {
  return {degree, c.range, c.values};
}

// Through the map or past it, in heights from -1 to 3, up or down; one in eight along a grid line or upright.
inline scene::MapLine random_line(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> place(-0.2 * size, 1.2 * size), height(-1, 3), uniform(0, 1);
  const double angle = 2 * pi * uniform(random);
  scene::MapLine line{place(random),   place(random),   height(random),
                      std::cos(angle), std::sin(angle), 0.3 * height(random)};
  const double odd = uniform(random);
  if (odd < 0.05) line.u = std::round(line.u), line.du = 0, line.dv = 1;
  if (odd > 0.05 && odd < 0.1) line.u = std::round(line.u), line.v = std::round(line.v), line.du = line.dv = 0.5;
  if (odd > 0.1 && odd < 0.125) line.du = line.dv = 0, line.dy = 1;
  return line;
}

inline const std::vector<scene::HeightProfile>& profiles() {
  static const std::vector<scene::HeightProfile> all = {scene::SameAtAllHeights{},
                                                        scene::Layers{{-0.5, 0.5, 1, 2.5}, {0.25, 1, 0.5, 0.1}},
                                                        scene::ExponentialFall{0.2, 0.7}};
  return all;
}

}  // namespace airlight::test
