// The inner loops of the method, for vectors of doubles; the best instruction set is chosen at run time.
//
// Depths are those of the Gaussians alone, for an extinction ratio of 1 (see fog.h); the constant term is added by the callers.
#pragma once
#include <vector>

#include "methods/fogshop/gaussian_arrays.h"

namespace airlight::fogshop {

// How the error function is evaluated. An error of e is an error of e times the depth of each Gaussian.
enum class Erf {
  precise,  // 1.2e-12
  erf10,    // 3.8e-6, a polynomial
  paper,    // 2.0e-4, the polynomial of the appendix; not monotone at its cut
};

// erf of one number by the named approximation.
double error_function(Erf, double x);

// The approximation itself: erf x is x times a polynomial in z = scale x^2 - 1 up to |x| = cut, and +-1 beyond.
struct ErfTable {
  double cut, scale;
  std::vector<double> coefficients;  // of z^0, z^1, ...
};
ErfTable erf_table(Erf);

// A ray with an end; the length may be infinite.
struct Line {
  Point3 origin;
  Vec3 direction;  // unit
  double length;   // [m]
};
// From one point to another; any direction if they coincide.
Line line_between(const Point3& from, const Point3& to);

// Crossings of a line with Gaussians: for each Gaussian whose sphere the line crosses, its Eq. 31 along the line,
// integral over [0, t] = depth (erf(a (t - middle)) + erf(a middle)). Arrays have room for whole vectors.
struct Crossings {
  int count = 0;
  std::vector<double> middle;  // [m] along the line
  std::vector<double> a;       // [1/m]
  std::vector<double> depth;   // c sqrt(pi)/(2a) exp(-a^2 p^2) [-], p the distance of the line from the centre
  std::vector<double> base;    // erf(a middle)
  std::vector<double> chord;   // [m] half the length of the line inside the sphere
  // In the arrays that were crossed, and in the whole of which these are a part; a vector of 0 after the last.
  std::vector<int> place, index;
  std::vector<double> x, y, z, half_depth;  // of those arrays
  // Set by whole_depths.
  std::vector<double> whole;       // optical depth over the whole line [-]
  std::vector<double> to_nearest;  // optical depth up to the point nearest to the centre, b_i^r of Eq. 10 clamped [-]

  void reserve(int gaussians);
};

// Replaces the contents of the crossings. The order is that of the arrays.
void cross(const GaussianArrays&, const Line&, Erf, Crossings&);

// Optical depth over [0, length] of the crossed line [-].
double total_depth(const Crossings&, double length, Erf);

// Like total_depth; also stores the parts of each crossing that depend on the line's own length, for any
// number of lights.
double whole_depths(Crossings&, double length, Erf);

// total_depth at several ends; `t` and `depth` hold a multiple of 8 values, depth is overwritten.
void depths_at(const Crossings&, const double* t, int count, double* depth, Erf);

// Like depths_at; also computes, for each channel, the sum of the depths times the colours of their Gaussians: the
// light that the medium scatters up to there. `gaussians` are those that were crossed; they have colours.
void scattering_depths_at(const Crossings&, const GaussianArrays& gaussians, const double* t, int count, double* depth,
                          double* const scattering[3], Erf);

// Optical depth from `from` to each of the points at parameters t of a ray; `t` and `depth` as above. All Gaussians are
// summed: choose them first by `near_triangle`.
void depths_from_point(const GaussianArrays&, const Point3& from, const Line& ray, const double* t, int count,
                       double* depth, Erf);

// Places of the Gaussians that may come within their radius of the triangle (corner, start and end of the stretch
// [lo, hi] of the ray): all that do, and a few more.
void near_triangle(const GaussianArrays&, const Point3& corner, const Line& ray, double lo, double hi,
                   std::vector<int>& places);

}  // namespace airlight::fogshop
