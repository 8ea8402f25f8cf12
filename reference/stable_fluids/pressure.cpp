#include "reference/stable_fluids/pressure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/stable_fluids/conjugate_gradients.h"
#include "scene/base/error.h"

namespace airlight::stable_fluids {
namespace {

template <class Real>
Real divergence_at(const Velocity<Real>& u, const Lattice& l, int i, int j, int k) {
  Real sum = 0;
  for (int a = 0; a < l.dimensions; ++a) {
    const Real* at = u[a].row(j, k) + i;
    sum += at[u[a].stride[a]] - at[0];
  }
  return sum / Real(l.h);
}

// Inflow and outflow through walls must be balanced in every part without an open side: otherwise no
// velocity without divergence exists.
void require_balance(const Lattice& l, const Obstacles& obstacles, const FluidParts& parts) {
  std::vector<double> net(parts.open.size(), 0.0), gross(parts.open.size(), 0.0);
  for (int a = 0; a < l.dimensions; ++a)
    for (int side = 0; side < 2; ++side) {
      const scene::Side& wall = l.sides[a][side];
      if (wall.kind != scene::Side::Kind::no_slip || wall.velocity[a] == 0) continue;
      std::array<int, 3> cell{};
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      cell[a] = side == 0 ? 0 : l.n[a] - 1;
      for (cell[b] = 0; cell[b] < l.n[b]; ++cell[b])
        for (cell[c] = 0; cell[c] < l.n[c]; ++cell[c]) {
          if (obstacles.any() && obstacles.solid.at(cell[0], cell[1], cell[2])) continue;
          const int part = parts.part[cell[0] + std::size_t(l.n[0]) * (cell[1] + std::size_t(l.n[1]) * cell[2])];
          const double flux = (side == 0 ? 1 : -1) * wall.velocity[a] * (l.dimensions == 2 ? l.h : l.h * l.h);
          net[part] += flux;
          gross[part] += std::abs(flux);
        }
    }
  for (std::size_t part = 1; part < net.size(); ++part)
    if (!parts.open[part] && std::abs(net[part]) > 1e-9 * gross[part])
      throw Error(fmt::format("{:.6g} {} flow {} a part of {} cells that has no open side, expected as much in as out",
                              std::abs(net[part]), l.dimensions == 2 ? "m^2/s" : "m^3/s",
                              net[part] > 0 ? "into" : "out of", parts.cells[part]));
}

}  // namespace

template <class Real>
struct Projection<Real>::Gradients {
  ConjugateGradients<Real> solver;
};

template <class Real>
Projection<Real>::Projection(const Lattice& l, const Obstacles& obstacles, PressureSolver which, double tolerance,
                             int most_iterations)
    : l_(l),
      obstacles_(obstacles),
      parts_(std::make_unique<FluidParts>(fluid_parts(l, obstacles))),
      right_side_(count_of(l.n)) {
  require_balance(l, obstacles, *parts_);
  if (which == PressureSolver::transforms) {
    if (obstacles.any()) throw Error("transforms solve for the pressure of boxes without obstacles only");
    box_ = std::make_unique<Helmholtz<Real>>(l, at_centers, true);
  } else {
    pressure_.resize(count_of(l.n));
    gradients_ = std::make_unique<Gradients>(
        Gradients{ConjugateGradients<Real>(l, obstacles, *parts_, which, tolerance, most_iterations)});
  }
}
template <class Real>
Projection<Real>::~Projection() = default;

template <class Real>
ProjectionReport Projection<Real>::operator()(Velocity<Real>& u) {
  divergence(u);
  ProjectionReport report;
  if (box_) {
    box_->solve(right_side_, 0, 1);
    subtract_gradient(right_side_, u);
  } else {
    report = gradients_->solver.solve(right_side_, pressure_);
    subtract_gradient(pressure_, u);
  }
  return report;
}

// Minus the divergence.
template <class Real>
void Projection<Real>::divergence(const Velocity<Real>& u) {
  for_rows(l_.n, [&](int j, int k) {
    Real* row = right_side_.data() + std::size_t(l_.n[0]) * (j + std::size_t(l_.n[1]) * k);
    for (int i = 0; i < l_.n[0]; ++i)
      row[i] = obstacles_.any() && obstacles_.solid.at(i, j, k) ? Real(0) : -divergence_at(u, l_, i, j, k);
  });
}

template <class Real>
void Projection<Real>::subtract_gradient(const std::vector<Real>& p, Velocity<Real>& u) const {
  const std::ptrdiff_t step[3] = {1, l_.n[0], std::ptrdiff_t(l_.n[0]) * l_.n[1]};
  for (int a = 0; a < l_.dimensions; ++a) {
    Field<Real>& component = u[a];
    const int n = l_.n[a];
    for_rows(component.n, [&](int j, int k) {
      Real* row = component.row(j, k);
      for (int i = 0; i < component.n[0]; ++i) {
        const int at = a == 0 ? i : a == 1 ? j : k;
        const bool first = at == 0 && !l_.periodic(a), last = at == n;
        if (first && l_.sides[a][0].kind != scene::Side::Kind::open) continue;
        if (last && l_.sides[a][1].kind != scene::Side::Kind::open) continue;
        if (obstacles_.any() && beside_solid(obstacles_, component, i, j, k)) continue;
        const std::ptrdiff_t here = i + j * step[1] + k * step[2];
        // Beyond an open side the pressure is minus that inside: 0 at the face.
        const Real after = last ? -p[here - step[a]] : p[here];
        const Real before = first ? -p[here] : at == 0 ? p[here + (n - 1) * step[a]] : p[here - step[a]];
        row[i] -= (after - before) / Real(l_.h);
      }
    });
  }
}

template <class Real>
double greatest_divergence(const Velocity<Real>& u, const Lattice& l, const Obstacles& obstacles) {
  std::vector<Real> rows(std::size_t(l.n[1]) * l.n[2]);
  for_rows(l.n, [&](int j, int k) {
    Real most = 0;
    for (int i = 0; i < l.n[0]; ++i)
      if (!obstacles.any() || !obstacles.solid.at(i, j, k))
        most = std::max(most, std::abs(divergence_at(u, l, i, j, k)));
    rows[j + std::size_t(l.n[1]) * k] = most;
  });
  return double(*std::max_element(rows.begin(), rows.end())) * l.h;
}

template <class Real>
double greatest_speed(const Velocity<Real>& u) {
  Real greatest = 0;
  for (const Field<Real>& f : u) {
    if (f.values.empty()) continue;
    std::vector<Real> rows(std::size_t(f.n[1]) * f.n[2]);
    for_rows(f.n, [&](int j, int k) {
      Real most = 0;
      for (int i = 0; i < f.n[0]; ++i) most = std::max(most, std::abs(f.at(i, j, k)));
      rows[j + std::size_t(f.n[1]) * k] = most;
    });
    greatest = std::max(greatest, *std::max_element(rows.begin(), rows.end()));
  }
  return double(greatest);
}

template class Projection<float>;
template class Projection<double>;
template double greatest_divergence(const Velocity<float>&, const Lattice&, const Obstacles&);
template double greatest_divergence(const Velocity<double>&, const Lattice&, const Obstacles&);
template double greatest_speed(const Velocity<float>&);
template double greatest_speed(const Velocity<double>&);

}  // namespace airlight::stable_fluids
