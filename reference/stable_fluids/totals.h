// Sums over the box: what history.csv records and tests hold.
#pragma once
#include "reference/stable_fluids/obstacles.h"
#include "scene/flow/flow.h"

namespace airlight::stable_fluids {

// `density` may be null. `cfl` is not set. Results do not depend on the number of threads.
template <class Real>
scene::Totals totals_of(const Velocity<Real>&, const Field<Real>* density, const Lattice&, const Obstacles&);

// "the velocity along y at cell (1, 2, 3) is nan": the first that is not finite; empty where all are.
template <class Real>
std::string what_is_not_finite(const Velocity<Real>&, const Lattice&);

}  // namespace airlight::stable_fluids
