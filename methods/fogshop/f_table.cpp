#include "methods/fogshop/f_table.h"

#include <algorithm>
#include <cmath>

#include "scene/math/types.h"

namespace airlight::fogshop {

constexpr double u_max = 10;

FTable::FTable(int size) : size_(size), values_(std::size_t(size) * size) {
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const double root = std::sqrt(u_max) * i / (size - 1);
      // The last column is v = pi/2 itself, which 0.5 pi * 1 rounds to.
      values_[std::size_t(i) * size + j] = fogshop::F(root * root, 0.5 * pi * j / (size - 1));
    }
}

double FTable::F(double u, double v) const {
  const double x = std::sqrt(std::clamp(u, 0.0, u_max) / u_max) * (size_ - 1);
  const double y = std::clamp(v / (0.5 * pi), 0.0, 1.0) * (size_ - 1);
  const int i = std::min(int(x), size_ - 2), j = std::min(int(y), size_ - 2);
  const double fx = x - i, fy = y - j;
  const double* row = &values_[std::size_t(i) * size_ + j];
  return (1 - fx) * ((1 - fy) * row[0] + fy * row[1]) + fx * ((1 - fy) * row[size_] + fy * row[size_ + 1]);
}

double FTable::homogeneous_airlight(const LightFromRay& light, double d_vp, double beta) const {
  if (!(beta > 0) || !(d_vp > 0)) return 0;
  const double d_sv = std::hypot(light.along, light.h);
  if (!(d_sv > 0)) return infinity;
  const double h = std::max(light.h, 1e-12 * d_sv);  // the printed form divides by sin gamma
  const double a0 = beta / (2 * pi * h) * std::exp(-beta * light.along);
  const double a1 = beta * h;
  const double gamma = std::atan2(h, light.along);
  const double end = std::isinf(d_vp) ? 0.5 * pi : std::atan((d_vp - light.along) / h);
  return std::max(0.0, a0 * (F(a1, 0.25 * pi + 0.5 * end) - F(a1, 0.5 * gamma)));
}

}  // namespace airlight::fogshop
