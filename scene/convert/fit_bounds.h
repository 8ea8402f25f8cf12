// Where a fit may move its Gaussians, and what minimisers have in common.
#pragma once
#include <algorithm>
#include <functional>
#include <vector>

#include "scene/media/gaussian_sum.h"

namespace airlight::scene {

// In samples of the grid, amplitudes over the greatest density.
struct FitBounds {
  Box centers;
  Interval widths, amplitudes;

  double lo(int v) const { return v < 3 ? centers.lo[v] : v == 3 ? widths.lo : amplitudes.lo; }
  double hi(int v) const { return v < 3 ? centers.hi[v] : v == 3 ? widths.hi : amplitudes.hi; }
};

// The five variables of a Gaussian, in the order of gradients.
inline double variable(const Gaussian& g, int v) { return v < 3 ? g.center[v] : v == 3 ? g.width : g.amplitude; }
inline double& variable(Gaussian& g, int v) { return v < 3 ? g.center[v] : v == 3 ? g.width : g.amplitude; }

inline void clamp_to(const FitBounds& bounds, Gaussian& g) {
  for (int v = 0; v < 5; ++v) variable(g, v) = std::clamp(variable(g, v), bounds.lo(v), bounds.hi(v));
}

struct MinimizerOptions {
  int iterations = 20;
  double tolerance = 1e-4;           // ends where an iteration lowers the objective by less than this fraction of it
  std::function<void()> check = {};  // called now and then; may throw to stop
};

struct Minimization {
  double value = 0;  // objective at the end, never above that at the start
  int iterations = 0;
  bool converged = false;  // by the tolerance, not by the number of iterations
};

}  // namespace airlight::scene
