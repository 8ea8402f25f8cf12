#include "reference/stable_fluids/forces.h"

#include <cmath>

namespace airlight::stable_fluids {
namespace {

// body(face) for all faces of a component that are no walls.
template <class Real, class Body>
void each_free_face(const Lattice& l, Field<Real>& component, const Body& body) {
  const int a = component.axis;
  for_rows(component.n, [&](int j, int k) {
    Real* row = component.row(j, k);
    for (int i = 0; i < component.n[0]; ++i) {
      const int at = a == 0 ? i : a == 1 ? j : k;
      if (on_side(component, a, at, l) && l.sides[a][at == 0 ? 0 : 1].kind != scene::Side::Kind::open) continue;
      body(row[i], i, j, k);
    }
  });
}

}  // namespace

template <class Real>
void add_buoyancy(double weight, double expansion, const Vec3& gravity, const Lattice& l, const Field<Real>& density,
                  const Field<Real>& temperature, double dt, Velocity<Real>& u) {
  for (int a = 0; a < l.dimensions; ++a) {
    const Real heavier = Real(0.5 * dt * gravity[a] * weight);
    const Real lighter = Real(0.5 * dt * gravity[a] * expansion);
    if (heavier == 0 && lighter == 0) continue;
    each_free_face(l, u[a], [&](Real& face, int i, int j, int k) {
      const Real* d = density.row(j, k) + i;
      const Real* t = temperature.row(j, k) + i;
      const std::ptrdiff_t before = -density.stride[a];
      face += heavier * (d[0] + d[before]) - lighter * (t[0] + t[before]);
    });
  }
}

template <class Real>
void add_pushes(const std::vector<scene::Push>& pushes, const Lattice& l, double time, double dt, Velocity<Real>& u) {
  for (const scene::Push& push : pushes) {
    const Interval part = intersect(push.time, {time, time + dt});
    if (part.empty()) continue;
    // The integral of cos(2 pi f t) over the part of the step.
    const double w = 2 * pi * push.frequency;
    const double seconds = w > 0 ? (std::sin(w * part.hi) - std::sin(w * part.lo)) / w : part.length();
    for (int a = 0; a < l.dimensions; ++a) {
      const Real change = Real(seconds * push.acceleration[a]);
      if (change == 0) continue;
      each_free_face(l, u[a], [&](Real& face, int i, int j, int k) {
        if (scene::contains(push.region, u[a].position(l, i, j, k))) face += change;
      });
    }
  }
}

template <class Real>
std::array<Real, 3> vorticity(const Velocity<Real>& u, const Lattice& l, int i, int j, int k) {
  // Difference along b of component a, centred: the component's mean over the cell's two faces, a cell before and after.
  const Real share = Real(0.25 / l.h);
  const auto gradient = [&](int a, int b) {
    if (a >= l.dimensions || b >= l.dimensions) return Real(0);
    const Field<Real>& f = u[a];
    const Real* at = f.row(j, k) + i;
    const std::ptrdiff_t along = f.stride[a], across = f.stride[b];
    return share * (at[across] + at[along + across] - at[-across] - at[along - across]);
  };
  return {gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1)};
}

template <class Real>
void add_confinement(double epsilon, const Lattice& l, const Obstacles& obstacles, double dt, Velocity<Real>& u) {
  if (!(epsilon > 0)) return;
  std::array<Field<Real>, 3> curl;
  Field<Real> size(l, at_centers);
  for (Field<Real>& c : curl) c = Field<Real>(l, at_centers);
  for_rows(l.n, [&](int j, int k) {
    for (int i = 0; i < l.n[0]; ++i) {
      if (obstacles.any() && obstacles.solid.at(i, j, k)) continue;
      const auto w = vorticity(u, l, i, j, k);
      for (int a = 0; a < 3; ++a) curl[a].at(i, j, k) = w[a];
      size.at(i, j, k) = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    }
  });
  // Mirrored at walls, whatever they are: the slope of what is there ends.
  Lattice closed = l;
  for (auto& axis : closed.sides)
    for (scene::Side& side : axis)
      if (side.kind != scene::Side::Kind::periodic) side = {scene::Side::Kind::free_slip};
  fill_ghosts(size, Quantity::density, closed);
  std::array<Field<Real>, 3>& force = curl;  // each cell reads its own vorticity only
  const Real share = Real(epsilon * l.h), half = Real(0.5 / l.h);
  for_rows(l.n, [&](int j, int k) {
    for (int i = 0; i < l.n[0]; ++i) {
      const Real* at = size.row(j, k) + i;
      Real n[3] = {0, 0, 0}, squares = 0;
      for (int a = 0; a < l.dimensions; ++a) {
        n[a] = half * (at[size.stride[a]] - at[-size.stride[a]]);
        squares += n[a] * n[a];
      }
      const Real scale = share / (std::sqrt(squares) + Real(1e-20));
      const Real w[3] = {curl[0].at(i, j, k), curl[1].at(i, j, k), curl[2].at(i, j, k)};
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        force[a].at(i, j, k) = scale * (n[b] * w[c] - n[c] * w[b]);
      }
    }
  });
  for (int a = 0; a < l.dimensions; ++a) {
    fill_ghosts(force[a], Quantity::density, closed);
    const Real change = Real(0.5 * dt);
    each_free_face(l, u[a], [&](Real& face, int i, int j, int k) {
      const Real* f = force[a].row(j, k) + i;
      face += change * (f[0] + f[-force[a].stride[a]]);
    });
  }
}

template <class Real>
void add_sources(const scene::FlowProblem& problem, const Lattice& l, double time, double dt, Quantity quantity,
                 Field<Real>& field) {
  for (const scene::Source& source : problem.sources) {
    const Interval part = intersect(source.time, {time, time + dt});
    if (part.empty()) continue;
    const bool smoke = quantity == Quantity::density;
    const Real added = Real(part.length() * (smoke ? source.density_rate : source.temperature_rate));
    const std::optional<double>& held = smoke ? source.density : source.temperature;
    if (added == 0 && !held) continue;
    for_rows(field.n, [&](int j, int k) {
      for (int i = 0; i < field.n[0]; ++i)
        if (scene::contains(source.region, field.position(l, i, j, k))) {
          Real& value = field.at(i, j, k);
          value = (held ? Real(*held) : value) + added;
        }
    });
  }
}

template <class Real>
void hold_velocities(const scene::FlowProblem& problem, const Lattice& l, double time, Velocity<Real>& u) {
  for (const scene::Source& source : problem.sources) {
    if (!source.velocity || !(source.time.lo <= time && time < source.time.hi)) continue;
    for (int a = 0; a < l.dimensions; ++a)
      each_free_face(l, u[a], [&](Real& face, int i, int j, int k) {
        if (scene::contains(source.region, u[a].position(l, i, j, k))) face = Real((*source.velocity)[a]);
      });
  }
}

#define AIRLIGHT_OF(Real)                                                                                         \
  template void add_buoyancy(double, double, const Vec3&, const Lattice&, const Field<Real>&, const Field<Real>&, \
                             double, Velocity<Real>&);                                                            \
  template void add_pushes(const std::vector<scene::Push>&, const Lattice&, double, double, Velocity<Real>&);     \
  template void add_confinement(double, const Lattice&, const Obstacles&, double, Velocity<Real>&);               \
  template std::array<Real, 3> vorticity(const Velocity<Real>&, const Lattice&, int, int, int);                   \
  template void add_sources(const scene::FlowProblem&, const Lattice&, double, double, Quantity, Field<Real>&);   \
  template void hold_velocities(const scene::FlowProblem&, const Lattice&, double, Velocity<Real>&);
AIRLIGHT_OF(float)
AIRLIGHT_OF(double)
#undef AIRLIGHT_OF

}  // namespace airlight::stable_fluids
