// The paper's tables of path integrals (Giroud and Biri 2010, section 4.2): a straight way through a unit cell, from one
// place on its perimeter to another, over each piece of a basis function.
#pragma once
#include <vector>

#include "methods/wavelet_fog/filters.h"
#include "scene/math/types.h"

namespace airlight::wavelet_fog {

// The pieces over unit cells of the scaling function, and of a wavelet psi(x) = sum_k q_k phi(2 x - k).
struct UnitPieces {
  int degree = 0;
  Taps q;  // no values: no wavelet

  int scaling() const { return degree + 1; }
  int wavelet() const {
    return q.values.empty() ? 0 : int(q.values.size() + degree + 1) / 2;
  }                                                  // its support, in whole cells
  int wavelet_first() const { return q.first / 2; }  // where that begins
  int count() const { return scaling() + wavelet(); }
  // Values of all pieces, first of the scaling function, then of the wavelet: piece m is phi(u + m), or psi(u +
  // wavelet_first + m); u in [0, 1], closed.
  void at(double u, double* values) const;
};

class PathTable {
 public:
  enum class Lookup { nearest, bilinear };
  // 4 R places on the perimeter, R >= 1; count^2 tables of (4 R)^2 floats, twice as many with `moments`.
  PathTable(const UnitPieces&, int R, Lookup, bool moments = false);

  int pieces() const { return count_; }  // along each axis
  bool moments() const { return channels_ > 1; }
  const std::vector<float>& values() const { return values_; }
  // Perimeter of the cell: bottom, right, top and left side in turn, 0 to 4.
  static double place(double u, double v);
  static Vec3 point(double place);  // (u, v, 0)
  // Integrals [cells] of pieces (a along u, b along v) over the way: out[a * count + b]. With moments, after them those of the piece
  // times the share of the way that lies behind: for factors of the height that are straight along it.
  void integrals(double entry, double exit, double* out) const;

 private:
  int count_, places_, channels_;
  Lookup lookup_;
  std::vector<float> values_;  // [entry][exit][channel][a][b]
};

}  // namespace airlight::wavelet_fog
