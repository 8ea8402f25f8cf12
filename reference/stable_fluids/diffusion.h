// Viscosity and diffusion, implicit in time: (1 - amount Laplacian) new = old, by transforms, or by conjugate gradients
// among obstacles.
#pragma once
#include "reference/stable_fluids/obstacles.h"
#include "reference/stable_fluids/transforms.h"

namespace airlight::stable_fluids {

template <class Real>
class Diffusion {
 public:
  // axis_of_field: the axis of a velocity component, or at_centers for fields at cell centres.
  Diffusion(const Lattice&, const Obstacles&, int axis_of_field, double tolerance, int most_iterations);
  // By amount = dt times the coefficient [m^2]. Ghosts are filled after. Throws Error.
  int operator()(Field<Real>&, Quantity, double amount);

 private:
  int solve_among_obstacles(Field<Real>&, Quantity, double amount);
  const Lattice& l_;
  const Obstacles& obstacles_;
  int axis_;
  double tolerance_;
  int most_iterations_;
  Helmholtz<Real> box_;
  std::vector<Real> values_;
};

}  // namespace airlight::stable_fluids
