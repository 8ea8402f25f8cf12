#include "reference/stable_fluids/field.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::stable_fluids {

using Kind = scene::Side::Kind;

Lattice make_lattice(const scene::FlowProblem& problem, int longest) {
  Lattice l;
  l.dimensions = problem.dimensions;
  l.low = problem.box.lo;
  l.sides = problem.sides;
  const Vec3 size = problem.box.size();
  double greatest = 0;
  for (int a = 0; a < l.dimensions; ++a) greatest = std::max(greatest, size[a]);
  l.h = greatest / longest;
  l.n = {1, 1, 1};
  for (int a = 0; a < l.dimensions; ++a) {
    const double cells = size[a] / l.h;
    l.n[a] = int(std::lround(cells));
    if (l.n[a] < 1 || std::abs(cells - l.n[a]) > 1e-6)
      throw Error(fmt::format("{} cells along the longest side of the box are {} along {}, expected a whole number",
                              longest, cells, "xyz"[a]));
  }
  if (l.dimensions == 2) l.low[2] = -0.5 * l.h;
  return l;
}

template <class Real>
Field<Real>::Field(const Lattice& l, int axis_) : axis(axis_), n(l.n) {
  if (axis >= 0 && !l.periodic(axis)) ++n[axis];
  for (int a = 0; a < l.dimensions; ++a) margin[a] = ghosts;
  stride = {1, n[0] + 2 * margin[0], 0};
  stride[2] = stride[1] * (n[1] + 2 * margin[1]);
  first = margin[0] + margin[1] * stride[1] + margin[2] * stride[2];
  // Kernels load whole vectors, beyond the end too.
  constexpr std::size_t beyond_end = 64;
  values.assign(std::size_t(stride[2]) * std::size_t(n[2] + 2 * margin[2]) + beyond_end, Real(0));
}

namespace {

// A wall through which fluid comes in brings its own density and temperature.
bool comes_in(const scene::Side& side, int axis, int which) {
  return which == 0 ? side.velocity[axis] > 0 : side.velocity[axis] < 0;
}

}  // namespace

Beyond beyond(const Lattice& l, int axis_of_field, int axis, int side) {
  switch (l.sides[axis][side].kind) {
    case Kind::periodic:
      return Beyond::periodic;
    case Kind::free_slip:
      return axis_of_field == axis ? Beyond::odd : Beyond::even;
    case Kind::no_slip:
      return axis_of_field >= 0 || comes_in(l.sides[axis][side], axis, side) ? Beyond::odd : Beyond::even;
    case Kind::open:
      return axis_of_field >= 0 ? Beyond::even : Beyond::odd;
  }
  return Beyond::even;
}

static double wall_velocity(const Lattice& l, int wall_axis, int side, int axis, const Vec3& cells) {
  const scene::Side& wall = l.sides[wall_axis][side];
  if (wall.kind != Kind::no_slip) return 0;
  double factor = 1;
  if (wall.regularized)
    for (int a = 0; a < l.dimensions; ++a)
      if (wall.velocity[a] != 0) {
        const double s = std::clamp(cells[a] / l.n[a], 0.0, 1.0);
        factor *= 16 * s * s * (1 - s) * (1 - s);
      }
  return factor * wall.velocity[axis];
}

double value_at_side(const Lattice& l, int axis_of_field, Quantity quantity, int axis, int side, const Vec3& cells) {
  if (quantity == Quantity::velocity) return wall_velocity(l, axis, side, axis_of_field, cells);
  const scene::Side& s = l.sides[axis][side];
  return quantity == Quantity::density ? s.density : s.temperature;
}

namespace {

template <class Real>
class Ghosts {
 public:
  Ghosts(Field<Real>& field, Quantity quantity, const Lattice& l, Walls walls)
      : f_(field), quantity_(quantity), l_(l), walls_(walls) {}

  void fill() {
    for (int axis = 0; axis < l_.dimensions; ++axis)
      for (int layer = 0; layer <= ghosts; ++layer)
        for (int side = 0; side < 2; ++side) fill(axis, side, layer);
  }

 private:
  // Layer 0 is the side itself, for fields that have samples there.
  void fill(int axis, int side, int layer) {
    const bool on_faces = f_.axis == axis, wraps = l_.periodic(axis);
    const int n = f_.n[axis], last = n - 1;
    if (layer == 0 && (!on_faces || wraps)) return;
    const int to = side == 0 ? -layer : last + layer;
    const int from = wraps      ? ((to % n) + n) % n
                     : on_faces ? (side == 0 ? layer : last - layer)
                                : (side == 0 ? layer - 1 : n - layer);
    const Beyond rule = beyond(l_, f_.axis, axis, side);
    if (layer == 0 && rule != Beyond::odd) return;
    const int b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2;
    // Axes before this one have their ghosts already, so that edges and corners get theirs.
    const int rim_b = b < axis ? f_.margin[b] : 0, rim_c = c < axis ? f_.margin[c] : 0;
    for (int v = -rim_c; v < f_.n[c] + rim_c; ++v)
      for (int u = -rim_b; u < f_.n[b] + rim_b; ++u) {
        const std::ptrdiff_t base = f_.first + u * f_.stride[b] + v * f_.stride[c];
        Real& ghost = f_.values[std::size_t(base + to * f_.stride[axis])];
        const Real inside = f_.values[std::size_t(base + from * f_.stride[axis])];
        if (rule != Beyond::odd) {
          ghost = inside;
          continue;
        }
        Vec3 cells = Vec3::Zero();
        cells[axis] = side == 0 ? 0 : l_.n[axis];
        cells[b] = u + f_.offset(b);
        cells[c] = v + f_.offset(c);
        const Real wall =
            walls_ == Walls::zero ? Real(0) : Real(value_at_side(l_, f_.axis, quantity_, axis, side, cells));
        ghost = layer == 0 || walls_ == Walls::carried ? wall : 2 * wall - inside;
      }
  }

  Field<Real>& f_;
  Quantity quantity_;
  const Lattice& l_;
  Walls walls_;
};

}  // namespace

template <class Real>
void fill_ghosts(Field<Real>& field, Quantity quantity, const Lattice& l, Walls walls) {
  Ghosts<Real>(field, quantity, l, walls).fill();
}

void for_each(int count, const std::function<void(int)>& body) {
  tbb::parallel_for(0, count, [&](int i) { body(i); });
}

template struct Field<float>;
template struct Field<double>;
template struct Field<std::uint8_t>;
template void fill_ghosts(Field<float>&, Quantity, const Lattice&, Walls);
template void fill_ghosts(Field<double>&, Quantity, const Lattice&, Walls);

}  // namespace airlight::stable_fluids
