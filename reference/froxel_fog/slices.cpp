#include "reference/froxel_fog/slices.h"

#include <algorithm>
#include <cmath>

namespace airlight::froxel_fog {

Slices::Slices(int count, Interval range, Distribution distribution, double parameter)
    : count_(count), range_(range), distribution_(distribution), parameter_(parameter) {}

double Slices::decode(double u) const {
  const auto [n, f] = range_;
  double z = n;
  switch (distribution_) {
    case Distribution::equal:
      z = n + (f - n) * u;
      break;
    case Distribution::log:
      z = n + std::expm1(u * std::log1p(parameter_ * (f - n))) / parameter_;
      break;
    case Distribution::power:
      z = n + (f - n) * std::pow(u, parameter_);
      break;
    case Distribution::exponential:
      z = n * std::pow(f / n, u);
      break;
  }
  return std::clamp(z, n, f);  // rounding
}

double Slices::encode(double z) const {
  const auto [n, f] = range_;
  if (!(z > n)) return 0;
  if (!(z < f)) return 1;
  double u = 0;
  switch (distribution_) {
    case Distribution::equal:
      u = (z - n) / (f - n);
      break;
    case Distribution::log:
      u = std::log1p(parameter_ * (z - n)) / std::log1p(parameter_ * (f - n));
      break;
    case Distribution::power:
      u = std::pow((z - n) / (f - n), 1 / parameter_);
      break;
    case Distribution::exponential:
      u = std::log(z / n) / std::log(f / n);
      break;
  }
  return std::clamp(u, 0.0, 1.0);
}

}  // namespace airlight::froxel_fog
