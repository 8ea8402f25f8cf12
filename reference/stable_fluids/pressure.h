// The projection onto velocities without divergence: Chorin 1968; on a staggered grid, Harlow and Welch 1965.
#pragma once
#include "reference/stable_fluids/obstacles.h"
#include "reference/stable_fluids/transforms.h"

namespace airlight::stable_fluids {

enum class PressureSolver {
  transforms,           // exact to rounding; boxes without obstacles
  incomplete_cholesky,  // conjugate gradients, preconditioned by MIC(0)
  transforms_as_guess,  // conjugate gradients, preconditioned by the box's transforms
};

struct ProjectionReport {
  int iterations = 0;
  double residual = 0;  // greatest, over the greatest right side; 0 of the direct solution
};

struct FluidParts;

template <class Real>
class Projection {
 public:
  // Throws Error for what has no solution: more flows into a part of the fluid than out, and it has no open side.
  Projection(const Lattice&, const Obstacles&, PressureSolver, double tolerance, int most_iterations);
  ~Projection();
  // Velocities on walls and obstacles, and ghosts, are set before; those on walls and obstacles stay. Throws Error where
  // conjugate gradients do not reach the tolerance.
  ProjectionReport operator()(Velocity<Real>&);
  const FluidParts& parts() const { return *parts_; }

 private:
  struct Gradients;
  void divergence(const Velocity<Real>&);
  void subtract_gradient(const std::vector<Real>& pressure, Velocity<Real>&) const;
  const Lattice& l_;
  const Obstacles& obstacles_;
  std::unique_ptr<FluidParts> parts_;
  // Minus the divergence, by cell; the pressure (times the time step, over the density) among obstacles.
  std::vector<Real> right_side_, pressure_;
  std::unique_ptr<Helmholtz<Real>> box_;
  std::unique_ptr<Gradients> gradients_;
};

// Greatest |div u| times h over fluid cells.
template <class Real>
double greatest_divergence(const Velocity<Real>&, const Lattice&, const Obstacles&);
template <class Real>
double greatest_speed(const Velocity<Real>&);  // of a component

}  // namespace airlight::stable_fluids
