// How a fogmap's density depends on the height y: a factor on the map. Closed set.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

// Factor 1 at all heights.
struct SameAtAllHeights {};

// Straight lines between knots, constant beyond the first and the last.
struct Layers {
  std::vector<double> heights;  // [m], rising, at least one
  std::vector<double> factors;  // [-], >= 0, one for each height
};

// 1 up to `base`, exp(-(y - base) / scale_height) above.
struct ExponentialFall {
  double base = 0;          // [m]
  double scale_height = 1;  // [m], > 0
};

using HeightProfile = std::variant<SameAtAllHeights, Layers, ExponentialFall>;

std::string profile_name(const HeightProfile&);  // "none", "layers", "exponential", as scene files call them

double factor_at(const HeightProfile&, double y);          // [-]
Interval factor_bounds(const HeightProfile&, Interval y);  // least and greatest over [y.lo, y.hi], exact
std::vector<double> height_breaks(const HeightProfile&);   // [m], rising: the factor is smooth between them
// Outside these heights the factor is 0, or below 1e-17 of its greatest; may be infinite.
Interval occupied_heights(const HeightProfile&);

}  // namespace airlight::scene
