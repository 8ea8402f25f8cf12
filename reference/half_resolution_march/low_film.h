// The marched film: blocks of film pixels, one ray and one depth each.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/math/types.h"

namespace airlight::half_resolution_march {

// Blocks along one side of the film. The last may have fewer pixels.
struct Blocks {
  int pixels, divide;
  int count() const { return (pixels + divide - 1) / divide; }
  int begin(int block) const { return block * divide; }
  int end(int block) const { return std::min(pixels, (block + 1) * divide); }
  double center(int block) const { return 0.5 * (begin(block) + end(block)); }  // [film pixels]
};

// Airlight RGB, transmittance RGB, two zeros: one register of the processor.
using FogPixel = Eigen::Array<float, 8, 1>;

// No fog at all.
inline FogPixel clear() {
  FogPixel fog = FogPixel::Zero();
  fog.segment<3>(3).setOnes();
  return fog;
}

// Depths are along the camera's axis [m], infinite where nothing ends the ray.
struct LowFilm {
  Blocks across, down;
  std::vector<FogPixel> fog;  // x fastest, row 0 the top
  std::vector<double> depth;  // none where nothing ends any ray

  LowFilm(int width, int height, int divide)
      : across{width, divide}, down{height, divide}, fog(std::size_t(across.count()) * down.count(), clear()) {}
  int width() const { return across.count(); }
  int height() const { return down.count(); }
  std::size_t at(int x, int y) const { return std::size_t(y) * width() + x; }
};

// Depths that differ by a share of a millionth are taken as equal where one of several pixels is chosen by them, so that rounding, of single
// precision too, does not choose.
constexpr double same_depth = 1e-6;

// 0 between two rays that nothing ends.
inline double depth_difference(double a, double b) { return a == b ? 0 : std::abs(a - b); }

}  // namespace airlight::half_resolution_march
