// Where the slices of a froxel grid lie in view depth: the distance from the camera along its forward direction [m].
#pragma once
#include "scene/math/types.h"

namespace airlight::froxel_fog {

// With n and f the ends of the range and u in [0, 1]:
//   equal        z = n + (f - n) u
//   log          z = n + (2^(u log2(c (f - n) + 1)) - 1) / c      (Unity HDRP, VBufferParameters; c = 2 - 2 * uniformity)
//   power        z = n + (f - n) u^p                              (Godot 4 with n = 0 and p = 2)
//   exponential  z = n (f / n)^u                                  (Wronski 2014)
enum class Distribution { equal, log, power, exponential };

class Slices {
 public:
  // `range`: 0 <= lo < hi, finite; lo > 0 for exponential. `parameter`: c [1/m] of log or p of power, > 0.
  Slices(int count, Interval range, Distribution, double parameter);

  int count() const { return count_; }
  Interval range() const { return range_; }
  double decode(double u) const;  // view depth [m]
  double encode(double z) const;  // u in [0, 1]; depths outside the range are moved to its ends

 private:
  int count_;
  Interval range_;
  Distribution distribution_;
  double parameter_;
};

}  // namespace airlight::froxel_fog
