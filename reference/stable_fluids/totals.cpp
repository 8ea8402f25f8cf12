#include "reference/stable_fluids/totals.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "reference/stable_fluids/forces.h"
#include "reference/stable_fluids/pressure.h"

namespace airlight::stable_fluids {
namespace {

// Sums of one slab.
struct Sums {
  double energy = 0, curl = 0, mass = 0, least = infinity, greatest = -infinity, speed = 0;
  Vec3 moment = Vec3::Zero();
};

template <class Real>
void add_faces(const Field<Real>& component, const Lattice& l, int j, int k, Sums& sums) {
  const int a = component.axis;
  const Real* row = component.row(j, k);
  for (int i = 0; i < component.n[0]; ++i) {
    const double u = double(row[i]);
    // A face on a side has half a cell.
    sums.energy += (on_side(component, a, a == 0 ? i : a == 1 ? j : k, l) ? 0.25 : 0.5) * u * u;
    sums.speed = std::max(sums.speed, std::abs(u));
  }
}

template <class Real>
void add_cells(const Velocity<Real>& u, const Field<Real>* density, const Lattice& l, const Obstacles& obstacles, int j,
               int k, Sums& sums) {
  for (int i = 0; i < l.n[0]; ++i) {
    if (obstacles.any() && obstacles.solid.at(i, j, k)) continue;
    for (const Real w : vorticity(u, l, i, j, k)) sums.curl += 0.5 * double(w) * double(w);
    if (!density) continue;
    const double d = double(density->at(i, j, k));
    sums.mass += d;
    sums.moment += d * density->position(l, i, j, k);
    sums.least = std::min(sums.least, d);
    sums.greatest = std::max(sums.greatest, d);
  }
}

}  // namespace

template <class Real>
scene::Totals totals_of(const Velocity<Real>& u, const Field<Real>* density, const Lattice& l,
                        const Obstacles& obstacles) {
  const int slab_axis = l.n[2] > 1 ? 2 : 1, slabs = l.n[slab_axis] + 1;
  std::vector<Sums> parts(slabs);
  for_each(slabs, [&](int s) {
    const auto rows = [&](const Size& n, const auto& body) {
      if (s >= n[slab_axis]) return;
      if (slab_axis == 1) return body(s, 0);
      for (int j = 0; j < n[1]; ++j) body(j, s);
    };
    for (int a = 0; a < l.dimensions; ++a) rows(u[a].n, [&](int j, int k) { add_faces(u[a], l, j, k, parts[s]); });
    rows(l.n, [&](int j, int k) { add_cells(u, density, l, obstacles, j, k, parts[s]); });
  });
  Sums all;
  for (const Sums& p : parts) {
    all.energy += p.energy;
    all.curl += p.curl;
    all.mass += p.mass;
    all.moment += p.moment;
    all.least = std::min(all.least, p.least);
    all.greatest = std::max(all.greatest, p.greatest);
    all.speed = std::max(all.speed, p.speed);
  }
  const double volume = l.cell_volume();
  scene::Totals t;
  t.energy = volume * all.energy;
  t.enstrophy = volume * all.curl;
  t.mass = volume * all.mass;
  if (density) t.density_least = all.least, t.density_greatest = all.greatest;
  t.greatest_speed = all.speed;
  t.divergence = all.speed > 0 ? greatest_divergence(u, l, obstacles) / all.speed : 0;
  t.center_of_mass =
      all.mass > 0 ? Point3(all.moment / all.mass) : Point3(l.low + 0.5 * l.h * Vec3(l.n[0], l.n[1], l.n[2]));
  return t;
}

template <class Real>
std::string what_is_not_finite(const Velocity<Real>& u, const Lattice& l) {
  for (int a = 0; a < l.dimensions; ++a) {
    std::atomic<bool> finite{true};
    for_rows(u[a].n, [&](int j, int k) {
      const Real* row = u[a].row(j, k);
      Real sum = 0;
      for (int i = 0; i < u[a].n[0]; ++i) sum += row[i] * Real(0);  // NaN and infinity leave NaN
      if (!(sum == 0)) finite = false;
    });
    if (finite) continue;
    for (int k = 0; k < u[a].n[2]; ++k)
      for (int j = 0; j < u[a].n[1]; ++j)
        for (int i = 0; i < u[a].n[0]; ++i)
          if (!std::isfinite(u[a].at(i, j, k)))
            return fmt::format("the velocity along {} at cell ({}, {}, {}) is {}", "xyz"[a], i, j, k,
                               double(u[a].at(i, j, k)));
  }
  return "";
}

template std::string what_is_not_finite(const Velocity<float>&, const Lattice&);
template std::string what_is_not_finite(const Velocity<double>&, const Lattice&);
template scene::Totals totals_of(const Velocity<float>&, const Field<float>*, const Lattice&, const Obstacles&);
template scene::Totals totals_of(const Velocity<double>&, const Field<double>*, const Lattice&, const Obstacles&);

}  // namespace airlight::stable_fluids
