// -w.grad f of many fields f at once, projected in L2: to the Gauss points of the box and back, in lines along x that stay in the cache.
//
// The points of an axis are not in order: point h + i is the mirror image of point i, h = ceil(m/2). Functions are even or odd in turn, so
// half of each matrix is enough (their sums over even and over odd ones, once added, once subtracted).
#pragma once
#include <vector>

#include "scene/math/legendre.h"
#include "scene/math/types.h"

namespace airlight::legendre_fluids {

// Basis functions of an axis: L, or phi.
struct AxisBasis {
  int count = 0, points = 0;                 // functions, even and odd in turn from an even one on; m
  Eigen::MatrixXd values, slopes, analysis;  // m x count, m x count, count x m
};

class AdvectionKernel {
 public:
  AdvectionKernel() = default;
  AdvectionKernel(int dimensions, const AxisBasis& free, const AxisBasis& wall);

  struct Field {
    int component;       // of the velocity, -1: a scalar: along this axis it is of phi
    const double* from;  // coefficients
    double* to;          // coefficients of -w.grad f; null: not asked for
    bool carries;        // its values are added to w[component]
  };
  // w = wind + the fields that carry; `wind` at the points, [x][y][z], per axis; null: none.
  void operator()(const std::vector<Field>&, const std::array<const double*, 3>& wind) const;

  // Matrices as vectors of eight read them.
  struct Tables {
    int count = 0, points = 0, half = 0;
    std::vector<double> values, slopes;                  // h x count: the first half of the points
    std::vector<double> analysis;                        // count x h
    std::vector<double> values_t, slopes_t, analysis_t;  // count x m, count x m, m x count, columns filled up to eights
  };

 private:
  int d_ = 0;
  std::array<Tables, 2> tables_;  // L, phi
};

// The points of a rule in the order that is said above. Its points are symmetric.
scene::LegendrePoints mirrored(scene::LegendrePoints);

}  // namespace airlight::legendre_fluids
