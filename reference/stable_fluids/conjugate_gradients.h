// The discrete Poisson equation among obstacles, by conjugate gradients: incomplete Cholesky with a modified diagonal
// (MIC(0), Gustafsson 1978, as Bridson 2008 has it for fluids), or the transforms of the box without its obstacles.
#pragma once
#include "reference/stable_fluids/pressure.h"

namespace airlight::stable_fluids {

// The fluid's parts that no face connects, by cell: 0 for solid cells, parts from 1.
struct FluidParts {
  std::vector<int> part;
  std::vector<bool> open;  // of each part; [0] stands for what is solid
  std::vector<std::size_t> cells;
};
FluidParts fluid_parts(const Lattice&, const Obstacles&);

template <class Real>
class ConjugateGradients {
 public:
  ConjugateGradients(const Lattice&, const Obstacles&, const FluidParts&, PressureSolver, double tolerance,
                     int most_iterations);
  // -Laplacian p = right side, by cell; p begins at 0. The mean of the right side over a closed part, which has no
  // solution, is dropped. Throws Error.
  ProjectionReport solve(const std::vector<Real>& right_side, std::vector<Real>& p);

 private:
  void apply(const std::vector<Real>& x, std::vector<Real>& y) const;  // y = -h^2 Laplacian x
  void factorize();
  void precondition(const std::vector<Real>& r, std::vector<Real>& z);
  void balance(std::vector<Real>& r) const;  // to a mean of 0 in each closed part
  template <class Body>
  void each_fluid(const Body&) const;  // body(cell, i, j, k)

  const Lattice& l_;
  const FluidParts& parts_;
  PressureSolver which_;
  double tolerance_;
  int most_iterations_;
  std::vector<std::uint8_t> fluid_;
  std::vector<float> diagonal_;     // of -h^2 Laplacian: whole numbers
  std::vector<Real> inverse_root_;  // of MIC(0)
  std::optional<Helmholtz<Real>> box_;
  std::vector<Real> r_, z_, s_, q_;
};

}  // namespace airlight::stable_fluids
