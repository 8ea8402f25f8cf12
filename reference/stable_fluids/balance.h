// Forces that pressure alone balances: uniform ones, and those that depend on the height alone.
//
// A force along an axis that depends on the place along this axis alone is the gradient of a pressure. In a closed part of
// the fluid it moves nothing, but a velocity that it has added and that is advected before the projection does: around
// obstacles and at walls the advected velocity is no gradient any more. So its mean over each plane of faces is left out.
#pragma once
#include "reference/stable_fluids/conjugate_gradients.h"

namespace airlight::stable_fluids {

template <class Real>
class Balance {
 public:
  Balance(const Lattice&, const Obstacles&, const FluidParts&);

  // Adds a force's change of a component in a step to the velocity, without the part that pressure balances. The part
  // that pressure would balance if no side were open, and if no way led around a periodic axis, is kept for
  // `add_deferred`. Values of `change` on walls and beside solid cells are not read.
  void add(const Field<Real>& change, Field<Real>& component);
  // After advection: a velocity that is uniform along the planes must not be advected before it has met the obstacles.
  void add_deferred(Velocity<Real>&);

 private:
  // Treatment of the profile along an axis in a part of the fluid.
  enum class Fate { balanced, around, deferred };  // around: all but its mean is balanced
  template <class Body>
  void each_face(const Field<Real>& component, int plane, const Body&) const;  // body(part, i, j, k)
  std::size_t at(int plane, int part) const { return std::size_t(plane) * parts_.open.size() + part; }

  const Lattice& l_;
  const Obstacles& obstacles_;
  const FluidParts& parts_;
  std::array<std::vector<Fate>, 3> fates_;       // of each axis and part
  std::array<std::vector<double>, 3> deferred_;  // of each axis, by plane and part; empty: nothing is deferred
};

}  // namespace airlight::stable_fluids
