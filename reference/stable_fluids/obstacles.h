// Which cells are solid.
#pragma once
#include <algorithm>

#include "reference/stable_fluids/field.h"

namespace airlight::stable_fluids {

struct Obstacles {
  Field<std::uint8_t> solid;        // 1 where a cell is, its ghosts mirrored or wrapped; empty where there are none
  std::size_t count = 0;            // of solid cells
  std::vector<std::uint8_t> clear;  // of each cell: no solid one as many cells away along any axis

  bool any() const { return count > 0; }
  // How far one may go from a place along any axis without entering a solid cell [cells].
  int clear_around(const Lattice& l, const Vec3& cells) const {
    std::size_t cell = 0;
    for (int a = 2; a >= 0; --a) cell = cell * l.n[a] + std::min(int(cells[a]), l.n[a] - 1);
    return clear[cell];
  }
};

// Cells whose centre lies in an obstacle. Throws Error where none is left, or an obstacle has none.
Obstacles make_obstacles(const scene::FlowProblem&, const Lattice&);

// Whether one of the two cells at a sample of a velocity is solid.
template <class Real>
bool beside_solid(const Obstacles&, const Field<Real>& component, int i, int j, int k);

// Velocities on the faces of solid cells are those of still walls.
template <class Real>
void stop_at_obstacles(const Obstacles&, Field<Real>& component);

// The farthest place on the way from a place in the fluid that no solid cell is in between [cells].
Vec3 until_solid(const Obstacles&, const Lattice&, const Vec3& from, const Vec3& to);

}  // namespace airlight::stable_fluids
