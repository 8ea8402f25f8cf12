// The latitude-longitude square and the sphere: +y at the top row, the centre column along -z, +x to the right of it.
#pragma once
#include <cmath>

#include "scene/math/elementary.h"
#include "scene/math/types.h"

namespace airlight::scene {

// u in [0, 1] from left to right, theta in [0, pi] from the top.
struct LatLong {
  double u;
  double theta;
};

inline LatLong to_lat_long(const Vec3& w) {
  return {0.5 + elementary::atan2(w[0], -w[2]) / (2 * pi),
          elementary::atan2(std::sqrt(w[0] * w[0] + w[2] * w[2]), w[1])};
}

// The direction with longitude u, height y = cos(theta) and s = sin(theta).
inline Vec3 from_lat_long(double u, double y, double s) {
  const elementary::SinCos longitude = elementary::sincos_turns(u - 0.5);
  return {s * longitude.sin, y, -s * longitude.cos};
}

inline Vec3 from_lat_long(const LatLong& p) {
  const elementary::SinCos polar = elementary::sincos_turns(p.theta / (2 * pi));
  return from_lat_long(p.u, polar.cos, polar.sin);
}

// Where a position falls on a grid of texel centres: the two nearest columns (around the world) and rows (clamped at
// the poles), and how far it is from the first to the second, in [0, 1]. `strip` counts the stretches between rows, 0
// the cap above the first row, `height` the cap below the last.
struct LatLongCell {
  int left, right;
  int top, bottom;
  int strip;
  double x;  // fraction from left to right
  double y;  // fraction of theta from top to bottom; any value in the caps
};

inline LatLongCell find_cell(const LatLong& p, int width, int height) {
  LatLongCell cell;
  const double column = p.u * width - 0.5, row = p.theta / pi * height - 0.5;
  const double first = std::fmin(std::fmax(std::floor(column), -1.0), width - 1.0);
  cell.left = first < 0 ? width - 1 : int(first);
  cell.right = cell.left + 1 == width ? 0 : cell.left + 1;
  cell.x = column - first;
  const double above = std::fmin(std::fmax(std::floor(row), -1.0), height - 1.0);
  cell.strip = int(above) + 1;
  cell.top = above < 0 ? 0 : int(above);
  cell.bottom = cell.strip < height ? cell.strip : height - 1;
  cell.y = std::fmin(std::fmax(row - above, 0.0), 1.0);
  return cell;
}

// Angle from the pole where a strip begins; strip height + 1 begins at pi.
inline double strip_begin(int strip, int height) {
  return strip == 0 ? 0 : strip > height ? pi : pi * (strip - 0.5) / height;
}

}  // namespace airlight::scene
