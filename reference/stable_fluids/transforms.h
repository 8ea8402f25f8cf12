// (a - b Laplacian) x = y on the samples of a field, by sines and cosines: exact to rounding in a box without obstacles.
//
// The second difference of what is mirrored at both ends of an axis, evenly or oddly, around a sample or between two, is
// diagonal in one of the sixteen discrete sine and cosine transforms; of what is periodic, in Fourier's. Its eigenvalues
// are -4/h^2 sin^2(angle / 2). FFTW has all of them.
#pragma once
#include <memory>

#include "reference/stable_fluids/field.h"

namespace airlight::stable_fluids {

template <class Real>
class Helmholtz {
 public:
  // For a component of the velocity, or for what is at centres. With `pressure` a side lets pass what the pressure knows
  // of it: even at walls, odd where it is open.
  Helmholtz(const Lattice&, int axis_of_field, bool pressure);
  ~Helmholtz();
  Helmholtz(Helmholtz&&) noexcept;

  // The samples that are unknown: without those on walls, x fastest, and where they begin in the field.
  const Size& size() const { return size_; }
  const Size& begin() const { return begin_; }
  // In place. Where the operator has a null space (a = 0, no open side) its part of the right side is dropped, and the
  // answer's mean is 0. a >= 0, b > 0, not both 0.
  void solve(std::vector<Real>& values, double a, double b) const;

 private:
  struct Plans;
  Size size_, begin_;
  int used_;                                  // axes
  std::array<std::vector<double>, 3> eigen_;  // of minus the second difference [1/m^2]
  double scale_ = 1;                          // one over the product of the transforms' logical lengths
  std::unique_ptr<Plans> plans_;
};

}  // namespace airlight::stable_fluids
