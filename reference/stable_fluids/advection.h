// Transport along the flow: semi-Lagrangian, and the two corrections by going there and back.
//
// Stam 1999 (traces back in time, interpolates); Fedkiw, Stam and Jensen 2001 (monotone cubic); Kim, Liu, Llamas and
// Rossignac 2005 (BFECC); Selle, Fedkiw, Kim, Liu and Rossignac 2008 (MacCormack and the limiters).
#pragma once
#include "reference/stable_fluids/field.h"
#include "reference/stable_fluids/obstacles.h"

namespace airlight::stable_fluids {

enum class Scheme { semi_lagrangian, maccormack, bfecc };
enum class Interpolation { linear, cubic };
// Where a correction leaves the range of the samples around the foot: nothing, clamped into it, or dropped.
enum class Limiter { none, clamp, revert };

struct Advection {
  Scheme scheme = Scheme::maccormack;
  Interpolation interpolation = Interpolation::linear;
  Limiter limiter = Limiter::clamp;
  int trace = 2;  // order of the Runge-Kutta method that finds the foot: 1, 2 or 4
};

// The least and greatest of the samples around each foot, laid out as a field.
template <class Real>
struct Range {
  std::vector<Real> least, greatest;
};

// Working memory of corrections, beside two fields; `second` is for BFECC alone. It may have any shape at first.
template <class Real>
struct Workspace {
  Field<Real> first, second;
  Range<Real> range;
  void shape_as(const Field<Real>&, Scheme);
};

// Advects a field by a time dt. `from` and the velocity have their ghosts filled; `to` has the shape of `from`, and its
// ghosts stay as they were. Feet end at walls and obstacles, and wrap along periodic axes.
template <class Real>
void advect(const Advection&, const Lattice&, const Obstacles&, const Velocity<Real>&, double dt, Quantity,
            const Field<Real>& from, Field<Real>& to, Workspace<Real>&);

// At any place of the box [cells]; linear between samples.
template <class Real>
double interpolate(const Field<Real>&, const Lattice&, const Vec3& cells);

}  // namespace airlight::stable_fluids
