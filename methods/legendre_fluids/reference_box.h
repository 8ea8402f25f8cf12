// The box of a flow problem as [-1, 1]^d, and what the problem puts there.
#pragma once
#include <string>

#include "methods/legendre_fluids/confined_space.h"
#include "scene/flow/flow_problem.h"

namespace airlight::legendre_fluids {

struct ReferenceBox {
  explicit ReferenceBox(const scene::FlowProblem&);
  Vec3 half;      // [m]; of an axis that is absent 1
  Point3 center;  // [m]
  int dimensions;
  Vec3 inside(const Point3& x) const;  // clamped
  Point3 outside(const Vec3& x) const { return center + half.cwiseProduct(x); }
};

bool carries_density(const scene::FlowProblem&);
bool carries_temperature(const scene::FlowProblem&);

// Coefficients of 1 inside a region and 0 outside, each axis times Lanczos factors: what is cut off leaves fewer waves. `what` begins the
// message of the Error that is thrown where the region is too small to be seen.
Array region_coefficients(const scene::FlowProblem&, const ConfinedSpace&, const ReferenceBox&, const scene::Region&,
                          const std::string& what);

}  // namespace airlight::legendre_fluids
