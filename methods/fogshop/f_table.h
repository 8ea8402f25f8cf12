// F as the paper evaluates it: a table in two variables, bilinear. Kept to show what that costs; the closed form of
// homogeneous_airlight.h needs no table.
#pragma once
#include <vector>

#include "methods/fogshop/homogeneous_airlight.h"

namespace airlight::fogshop {

// size x size entries over sqrt(u) in [0, sqrt(10)], v in [0, pi/2]; u > 10 is clamped. Error of F at most 1.1e-4 for
// 256 (2e-3 for 64); of the airlight, which divides by sin gamma and subtracts, median 7e-5, 99th percentile 3e-2.
class FTable {
 public:
  explicit FTable(int size = 256);

  double F(double u, double v) const;

  int size() const { return size_; }
  const std::vector<double>& values() const { return values_; }  // u slowest

  // L_a^h of Zhou et al. 2007, as printed before Eq. 17, for an intensity of 1 W/sr.
  double homogeneous_airlight(const LightFromRay&, double d_vp, double beta) const;

 private:
  int size_;
  std::vector<double> values_;  // u slowest
};

}  // namespace airlight::fogshop
