// A flow's fields as others know them: voxel grids and frames.
#pragma once
#include "reference/stable_fluids/field.h"
#include "scene/flow/flow.h"

namespace airlight::stable_fluids {

// Not below 0; `density` may be null: nothing anywhere.
template <class Real>
scene::GridPointer density_grid(const Lattice&, const Field<Real>* density);

template <class Real>
scene::Frame frame_of(const Lattice&, const Velocity<Real>&, const Field<Real>* density,
                      const Field<Real>* temperature);

}  // namespace airlight::stable_fluids
