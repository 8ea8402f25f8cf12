// Where the evaluators of the airlight integral hold: the paper's polynomial and the mapped rule against 128 nodes in
// double precision, over extinction and distance, over angles, over a picture, and against time.
#pragma once
#include <array>
#include <vector>

#include "gpu/context.h"

namespace airlight::experiments::shadow_planes {

struct Evaluator {
  enum class Form {
    polynomial,   // of theta, over the lit part alone
    differences,  // of Gamma from the eye, as in section 4.2
    rule,         // mapped Gauss-Legendre
  };
  Form form = Form::polynomial;
  int terms = 4;        // degree or nodes
  bool single = false;  // precision
};

// Distribution of relative errors.
struct Spread {
  double median = 0, p99 = 0, greatest = 0;
};

// The map: the light's foot point lies 5 m from the eye; lit are 1 to 2, 4 to 6 and 8 to 9 m: before, around and behind
// it. Extinction 1e-6 to 1e4 [1/m], h 1e-6 to 1e3 [m], both rounded to single precision.
inline constexpr double map_foot = 5;
inline const std::array<std::array<double, 2>, 3> map_parts = {{{1, 1}, {4, 2}, {8, 1}}};  // begin, length
// Greatest relative error of the parts that are normal numbers of the precision; NaN: none is.
double map_error(const Evaluator&, double extinction, double h);
// Relative error of the reference, by comparing 128 nodes with 256.
double map_reference_error(double extinction, double h);

// Relative error of the polynomial's integral about theta = 0 over random angles in [-reach, reach], a log-uniform, in
// double precision.
Spread errors_over_angles(int degree, double reach, double a_low, double a_high, int cases);

// Endless rays over 0 to 90 degrees from a light at this optical distance: rms error over mean radiance.
double error_over_image(int degree, double optical_distance, int rays);

// One evaluation on lit parts in fog that the light is 0.1 to 3 optical lengths away in: its errors, and its time in each
// run [s].
struct Timed {
  Spread errors;
  std::vector<double> seconds;
};
// Errors, and times of one processor thread (its own processor time).
Timed errors_and_times(const Evaluator&, int cases, int runs);
// Errors and times of the whole device, in single precision. The form `differences` is not available.
Timed errors_and_times(gpu::Context&, const Evaluator&, int cases, int runs);

}  // namespace airlight::experiments::shadow_planes
