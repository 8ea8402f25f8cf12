// Forces on the fluid, and sources.
#pragma once
#include "reference/stable_fluids/obstacles.h"

namespace airlight::stable_fluids {

// Buoyancy (Boussinesq): gravity times weight * density - expansion * temperature. Fedkiw, Stam and Jensen 2001, Eq. 8,
// with SI units. On all faces but walls; those beside solid cells are stopped afterwards.
template <class Real>
void add_buoyancy(double weight, double expansion, const Vec3& gravity, const Lattice&, const Field<Real>& density,
                  const Field<Real>& temperature, double dt, Velocity<Real>&);

// Accelerations in time, at their mean over the step.
template <class Real>
void add_pushes(const std::vector<scene::Push>&, const Lattice&, double time, double dt, Velocity<Real>&);

// epsilon h (N x w), N = grad|w| / |grad|w|| and 0 where that is: Steinhoff and Underhill 1994; Fedkiw et al. 2001, Eq.
// 9 to 11. Ghosts of the velocity are filled before. Vorticity is that at cell centres.
template <class Real>
void add_confinement(double epsilon, const Lattice&, const Obstacles&, double dt, Velocity<Real>&);

// Curl of the velocity at the centre of a cell [1/s]: central differences.
template <class Real>
std::array<Real, 3> vorticity(const Velocity<Real>&, const Lattice&, int i, int j, int k);

// Adds the contribution of sources in a step, and sets the values that sources hold.
template <class Real>
void add_sources(const scene::FlowProblem&, const Lattice&, double time, double dt, Quantity, Field<Real>&);
template <class Real>
void hold_velocities(const scene::FlowProblem&, const Lattice&, double time, Velocity<Real>&);

}  // namespace airlight::stable_fluids
