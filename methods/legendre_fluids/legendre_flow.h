// A fluid of coefficients as a scene::Flow: the box in metres, sources, forces, sums, grids.
#pragma once
#include <memory>

#include "methods/legendre_fluids/fluid.h"
#include "scene/flow.h"

namespace airlight::legendre_fluids {

// The box of a problem as [-1, 1]^d.
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

// Starts the fluid: its velocity, and what it carries. `cells` are those of frames and media along the longest axis. Throws Error where a region of a source or force is too small to be seen.
std::unique_ptr<scene::Flow> start_flow(std::shared_ptr<const scene::FlowProblem>, std::unique_ptr<Fluid>, int cells);

}  // namespace airlight::legendre_fluids
