// Requirements of a problem for a grid, checked before anything is allocated. All functions throw Error.
#pragma once
#include "reference/stable_fluids/field.h"

namespace airlight::stable_fluids {

// A sample in the region of each source and force, which would be without effect.
void require_samples(const scene::FlowProblem&, const Lattice&);

// Memory for the fields of a number of so many bytes: those that every flow has, so that what is refused cannot run.
void require_memory(const Lattice&, std::size_t bytes_of_number);

}  // namespace airlight::stable_fluids
