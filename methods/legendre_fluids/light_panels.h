// The integral of s(z) exp(-e(z)) over [-1, 1] for Legendre series s and e, by Gauss points on panels.
//
// A panel is halved, its series exactly with it, until what its points miss is within the tolerance: by the coefficients beyond those that
// they integrate exactly, those of exp(-e) bounded by a power series in e's own. Where e grows from a bright end to a dark
// one that makes panels that double in length, however great e is, and one panel where it is small. The brighter half comes first, and
// tells how much matters.
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::legendre_fluids {

// For one, or for three channels that share places.
struct PanelSeries {
  int depths = 1, sources = 1;       // 1 or 3 each
  std::vector<double> coefficients;  // [depths, then sources][coefficient]
};

class PanelRule {
 public:
  // Series of n coefficients, n >= 2; points of a panel 2 to 16; tolerance relative to the integral.
  PanelRule(int n, int points, double tolerance);
  int coefficients() const { return n_; }

  // Working memory of a thread.
  struct Work {
    std::vector<double> series;
    long panels = 0;
  };
  // Adds the integral times `scale` to `sum`, whose value so far is what the tolerance is relative to, too.
  void add(const PanelSeries&, double scale, Rgb& sum, Work&) const;

 private:
  struct Integral;
  int n_, points_;
  double tolerance_;
  std::vector<double> half_;             // [lower, upper][column][row]: restrictions, upper triangular, by columns
  std::vector<double> values_, weight_;  // [coefficient][point]; of points
  std::vector<double> greatest_;         // of |L_k|
};

}  // namespace airlight::legendre_fluids
