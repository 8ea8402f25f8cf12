// Samples on a staggered grid, with two layers of ghosts around them.
//
// Positions are in cells from the box's low corner: cells are [i, i+1]. A field has its samples at cell centres along
// every axis, i + 1/2, but a component of the velocity sits on the faces of its own axis: there at i. A wall has a
// sample of its own then; of a periodic axis the last face is the first and is left out.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene/flow/flow_problem.h"

namespace airlight::stable_fluids {

inline constexpr int ghosts = 2;  // of each side: what a cubic reads

using Size = std::array<int, 3>;  // samples or cells along x, y, z
inline std::size_t count_of(const Size& n) { return std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]); }

// The box in cells. In two dimensions n[2] is 1 and the third axis has neither ghosts nor a velocity.
struct Lattice {
  int dimensions = 3;
  Size n{};      // cells
  double h = 1;  // [m]
  Point3 low = Point3::Zero();
  std::array<std::array<scene::Side, 2>, 3> sides;

  bool periodic(int axis) const { return sides[axis][0].kind == scene::Side::Kind::periodic; }
  double cell_volume() const { return dimensions == 2 ? h * h : h * h * h; }  // in 2D per metre of depth
};

// The lattice with `longest` cells along the longest axis. Throws Error where an axis has not a whole number of them, to
// 1e-6 of a cell.
Lattice make_lattice(const scene::FlowProblem&, int longest);

inline constexpr int at_centers = -1;  // or the axis on whose faces a field has its samples

template <class Real>
struct Field {
  int axis = at_centers;
  Size n{};                     // samples
  std::array<int, 3> margin{};  // ghosts of each side
  std::array<std::ptrdiff_t, 3> stride{};
  std::ptrdiff_t first = 0;  // of sample (0, 0, 0)
  std::vector<Real> values;  // x fastest, ghosts included

  Field() = default;
  Field(const Lattice&, int axis);

  Real* row(int j, int k) { return values.data() + first + j * stride[1] + k * stride[2]; }
  const Real* row(int j, int k) const { return values.data() + first + j * stride[1] + k * stride[2]; }
  Real& at(int i, int j, int k) { return row(j, k)[i]; }
  Real at(int i, int j, int k) const { return row(j, k)[i]; }
  // Where its samples are within a cell.
  double offset(int a) const { return a == axis ? 0.0 : 0.5; }
  Point3 position(const Lattice& l, int i, int j, int k) const {  // [m]
    return l.low + l.h * Vec3(i + offset(0), j + offset(1), k + offset(2));
  }
};

template <class Real>
using Velocity = std::array<Field<Real>, 3>;  // in two dimensions the third is empty

// A sample of a velocity that lies on a wall, or on an open side: the first or last along its own axis.
template <class Real>
bool on_side(const Field<Real>& field, int axis, int i, const Lattice& l) {
  return field.axis == axis && !l.periodic(axis) && (i == 0 || i == l.n[axis]);
}

// Continuation of a field beyond a side: mirrored (its slope is 0 there), or mirrored with the sign
// turned around a value.
enum class Beyond { periodic, even, odd };
Beyond beyond(const Lattice&, int axis_of_field, int axis, int side);

// Sets ghosts, and velocities on walls, of a field that `quantity` names: a component of the velocity by its axis.
// `zero`: of a difference of two such fields, for which all that walls bring is 0. `carried`: where what is carried has a
// value at a side, all of its ghosts have it, so that what is interpolated is never beyond it.
enum class Quantity { velocity, density, temperature };
enum class Walls { as_they_are, zero, carried };
template <class Real>
void fill_ghosts(Field<Real>&, Quantity, const Lattice&, Walls = Walls::as_they_are);

// The value around which a field is mirrored at a side, at a place [cells].
double value_at_side(const Lattice&, int axis_of_field, Quantity, int axis, int side, const Vec3& cells);

// body(k) for slabs of a field: rows of one z, or of one y in two dimensions, in parallel. Sums go by slab, in order.
void for_each(int count, const std::function<void(int)>& body);
// body(j, k) for all rows.
template <class Body>
void for_rows(const Size& n, const Body& body) {
  if (n[2] > 1)
    for_each(n[2], [&](int k) {
      for (int j = 0; j < n[1]; ++j) body(j, k);
    });
  else
    for_each(n[1], [&](int j) { body(j, 0); });
}

}  // namespace airlight::stable_fluids
