#include "reference/stable_fluids/conjugate_gradients.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::stable_fluids {
namespace {

constexpr int patience = 300;  // iterations without a lower residual: what is left is rounding

std::size_t cell_of(const Lattice& l, int i, int j, int k) {
  return i + std::size_t(l.n[0]) * (j + std::size_t(l.n[1]) * k);
}

// The cell beyond a face of a cell: nothing at walls and open sides.
std::optional<std::size_t> neighbour(const Lattice& l, std::array<int, 3> cell, int axis, int side) {
  int& x = cell[axis];
  x += side == 0 ? -1 : 1;
  if (x < 0 || x >= l.n[axis]) {
    if (!l.periodic(axis)) return {};
    x = x < 0 ? l.n[axis] - 1 : 0;
  }
  return cell_of(l, cell[0], cell[1], cell[2]);
}

bool open_at(const Lattice& l, const std::array<int, 3>& cell, int axis, int side) {
  return l.sides[axis][side].kind == scene::Side::Kind::open && cell[axis] == (side == 0 ? 0 : l.n[axis] - 1);
}

template <class Body>
void each_cell(const Lattice& l, const Body& body) {
  std::size_t cell = 0;
  for (int k = 0; k < l.n[2]; ++k)
    for (int j = 0; j < l.n[1]; ++j)
      for (int i = 0; i < l.n[0]; ++i, ++cell) body(cell, std::array<int, 3>{i, j, k});
}

std::vector<std::uint8_t> fluid_cells(const Lattice& l, const Obstacles& obstacles) {
  std::vector<std::uint8_t> fluid(count_of(l.n), 1);
  if (obstacles.any())
    each_cell(l, [&](std::size_t cell, const auto& c) { fluid[cell] = !obstacles.solid.at(c[0], c[1], c[2]); });
  return fluid;
}

// Sums by slab, then in their order: the same for any number of threads.
template <class Body>
double sum_by_slabs(int slabs, const Body& body) {
  std::vector<double> sums(slabs);
  for_each(slabs, [&](int k) { sums[k] = body(k); });
  double sum = 0;
  for (const double s : sums) sum += s;
  return sum;
}

template <class Real>
double dot(const std::vector<Real>& a, const std::vector<Real>& b, int slabs) {
  const std::size_t each = a.size() / slabs;
  return sum_by_slabs(slabs, [&](int k) {
    double sum = 0;
    for (std::size_t i = k * each; i < (k + 1) * each; ++i) sum += double(a[i]) * double(b[i]);
    return sum;
  });
}

template <class Real>
double greatest(const std::vector<Real>& v) {
  double most = 0;
  for (const Real x : v) most = std::max(most, std::abs(double(x)));
  return most;
}

}  // namespace

FluidParts fluid_parts(const Lattice& l, const Obstacles& obstacles) {
  const std::vector<std::uint8_t> fluid = fluid_cells(l, obstacles);
  FluidParts parts{std::vector<int>(fluid.size(), 0), {true}, {0}};
  std::vector<std::array<int, 3>> waiting;
  each_cell(l, [&](std::size_t start, const std::array<int, 3>& at) {
    if (!fluid[start] || parts.part[start] != 0) return;
    const int part = int(parts.open.size());
    parts.open.push_back(false);
    parts.cells.push_back(0);
    parts.part[start] = part;
    waiting.push_back(at);
    while (!waiting.empty()) {
      const std::array<int, 3> cell = waiting.back();
      waiting.pop_back();
      ++parts.cells[part];
      for (int a = 0; a < l.dimensions; ++a)
        for (int side = 0; side < 2; ++side) {
          if (open_at(l, cell, a, side)) parts.open[part] = true;
          const auto next = neighbour(l, cell, a, side);
          if (!next || !fluid[*next] || parts.part[*next] != 0) continue;
          parts.part[*next] = part;
          const int x = int(*next % l.n[0]), y = int(*next / l.n[0] % l.n[1]), z = int(*next / l.n[0] / l.n[1]);
          waiting.push_back({x, y, z});
        }
    }
  });
  return parts;
}

template <class Real>
ConjugateGradients<Real>::ConjugateGradients(const Lattice& l, const Obstacles& obstacles, const FluidParts& parts,
                                             PressureSolver which, double tolerance, int most_iterations)
    : l_(l),
      parts_(parts),
      which_(which),
      tolerance_(tolerance),
      most_iterations_(most_iterations),
      fluid_(fluid_cells(l, obstacles)),
      diagonal_(fluid_.size(), 0) {
  each_cell(l, [&](std::size_t cell, const std::array<int, 3>& at) {
    if (!fluid_[cell]) return;
    for (int a = 0; a < l.dimensions; ++a)
      for (int side = 0; side < 2; ++side) {
        const auto next = neighbour(l, at, a, side);
        if (open_at(l, at, a, side))
          diagonal_[cell] += 2;
        else if (next && fluid_[*next] && *next != cell)
          diagonal_[cell] += 1;
      }
  });
  for (auto* v : {&r_, &z_, &s_, &q_}) v->assign(fluid_.size(), Real(0));
  if (which == PressureSolver::incomplete_cholesky)
    factorize();
  else
    box_.emplace(l, at_centers, true);
}

template <class Real>
void ConjugateGradients<Real>::apply(const std::vector<Real>& x, std::vector<Real>& y) const {
  const std::ptrdiff_t step[3] = {1, l_.n[0], std::ptrdiff_t(l_.n[0]) * l_.n[1]};
  for_rows(l_.n, [&](int j, int k) {
    const std::array<int, 3> row{0, j, k};
    std::ptrdiff_t cell = std::ptrdiff_t(cell_of(l_, 0, j, k));
    for (int i = 0; i < l_.n[0]; ++i, ++cell) {
      if (!fluid_[cell]) {
        y[cell] = 0;
        continue;
      }
      Real sum = Real(diagonal_[cell]) * x[cell];
      for (int a = 0; a < l_.dimensions; ++a) {
        const int at = a == 0 ? i : row[a], n = l_.n[a];
        if (n == 1) continue;
        const std::ptrdiff_t around = (n - 1) * step[a];
        // Solid cells have x = 0.
        if (at > 0)
          sum -= x[cell - step[a]];
        else if (l_.periodic(a))
          sum -= x[cell + around];
        if (at < n - 1)
          sum -= x[cell + step[a]];
        else if (l_.periodic(a))
          sum -= x[cell - around];
      }
      y[cell] = sum;
    }
  });
}

template <class Real>
void ConjugateGradients<Real>::factorize() {
  constexpr double modified = 0.97, least = 0.25;
  inverse_root_.assign(fluid_.size(), Real(0));
  const std::ptrdiff_t step[3] = {1, l_.n[0], std::ptrdiff_t(l_.n[0]) * l_.n[1]};
  each_cell(l_, [&](std::size_t cell, const std::array<int, 3>& at) {
    if (!fluid_[cell]) return;
    double e = diagonal_[cell];
    for (int a = 0; a < l_.dimensions; ++a) {
      if (at[a] == 0 || !fluid_[cell - step[a]]) continue;
      const std::size_t before = cell - step[a];
      const double inverse = double(inverse_root_[before]) * double(inverse_root_[before]);
      int others = 0;  // entries of the cell before, upwards along the other axes: what the factor leaves out
      for (int b = 0; b < l_.dimensions; ++b) {
        std::array<int, 3> there = at;
        --there[a];
        if (b != a && there[b] < l_.n[b] - 1 && fluid_[before + step[b]]) ++others;
      }
      e -= inverse * (1 + modified * others);
    }
    if (e < least * diagonal_[cell]) e = diagonal_[cell];
    inverse_root_[cell] = e > 0 ? Real(1 / std::sqrt(e)) : Real(0);
  });
}

template <class Real>
void ConjugateGradients<Real>::precondition(const std::vector<Real>& r, std::vector<Real>& z) {
  if (which_ != PressureSolver::incomplete_cholesky) {
    z = r;
    box_->solve(z, 0, 1 / (l_.h * l_.h));
    for_rows(l_.n, [&](int j, int k) {
      const std::size_t row = cell_of(l_, 0, j, k);
      for (int i = 0; i < l_.n[0]; ++i)
        if (!fluid_[row + i]) z[row + i] = 0;
    });
    return;
  }
  const std::ptrdiff_t step[3] = {1, l_.n[0], std::ptrdiff_t(l_.n[0]) * l_.n[1]};
  each_cell(l_, [&](std::size_t cell, const std::array<int, 3>& at) {
    Real sum = r[cell];
    for (int a = 0; a < l_.dimensions; ++a)
      if (at[a] > 0) sum += inverse_root_[cell - step[a]] * q_[cell - step[a]];
    q_[cell] = fluid_[cell] ? sum * inverse_root_[cell] : Real(0);
  });
  std::size_t cell = fluid_.size();
  for (int k = l_.n[2] - 1; k >= 0; --k)
    for (int j = l_.n[1] - 1; j >= 0; --j)
      for (int i = l_.n[0] - 1; i >= 0; --i) {
        --cell;
        const std::array<int, 3> at{i, j, k};
        Real sum = q_[cell];
        for (int a = 0; a < l_.dimensions; ++a)
          if (at[a] < l_.n[a] - 1) sum += inverse_root_[cell] * z[cell + step[a]];
        z[cell] = fluid_[cell] ? sum * inverse_root_[cell] : Real(0);
      }
}

template <class Real>
void ConjugateGradients<Real>::balance(std::vector<Real>& r) const {
  const std::size_t parts = parts_.open.size();
  if (std::find(parts_.open.begin() + 1, parts_.open.end(), false) == parts_.open.end()) return;
  const int slabs = parts > r.size() / 64 ? 1 : l_.n[2] > 1 ? l_.n[2] : l_.n[1];
  const std::size_t each = r.size() / slabs;
  // Sums by slab, then in their order: the same for any number of threads.
  std::vector<double> sums(slabs * parts, 0.0);
  for_each(slabs, [&](int k) {
    for (std::size_t c = k * each; c < (k + 1) * each; ++c) sums[k * parts + parts_.part[c]] += double(r[c]);
  });
  std::vector<Real> means(parts, Real(0));
  for (std::size_t part = 1; part < parts; ++part) {
    if (parts_.open[part]) continue;
    double sum = 0;
    for (int k = 0; k < slabs; ++k) sum += sums[k * parts + part];
    means[part] = Real(sum / double(parts_.cells[part]));
  }
  for_each(slabs, [&](int k) {
    for (std::size_t c = k * each; c < (k + 1) * each; ++c) r[c] -= means[parts_.part[c]];
  });
}

template <class Real>
ProjectionReport ConjugateGradients<Real>::solve(const std::vector<Real>& right_side, std::vector<Real>& p) {
  const Real h2 = Real(l_.h * l_.h);
  std::fill(p.begin(), p.end(), Real(0));
  for (std::size_t c = 0; c < r_.size(); ++c) r_[c] = fluid_[c] ? h2 * right_side[c] : Real(0);
  balance(r_);
  const double goal = tolerance_ * greatest(r_), most = greatest(r_);
  ProjectionReport report;
  if (most == 0) return report;
  precondition(r_, z_);
  s_ = z_;
  const int slabs = l_.n[2] > 1 ? l_.n[2] : l_.n[1];
  double rz = dot(r_, z_, slabs);
  const std::size_t each = r_.size() / slabs;
  double least = infinity;
  int of_least = 0;
  for (report.iterations = 1; report.iterations <= most_iterations_; ++report.iterations) {
    apply(s_, z_);
    const double way = rz / dot(s_, z_, slabs);
    for_each(slabs, [&](int k) {
      for (std::size_t c = k * each; c < (k + 1) * each; ++c) {
        p[c] += Real(way) * s_[c];
        r_[c] -= Real(way) * z_[c];
      }
    });
    // Rounding adds a constant, which no pressure takes away: the residual would never fall below it.
    balance(r_);
    report.residual = greatest(r_) / most;
    if (greatest(r_) <= goal) return report;
    if (report.residual < least) least = report.residual, of_least = report.iterations;
    if (report.iterations - of_least > patience)
      throw Error(
          fmt::format("the pressure's residual falls no further than {:.3g} of its right side, reached after {} "
                      "iterations; expected at most {:.3g}: rounding, where precision is float",
                      least, of_least, tolerance_));
    precondition(r_, z_);
    const double next = dot(r_, z_, slabs), beta = next / rz;
    rz = next;
    for_each(slabs, [&](int k) {
      for (std::size_t c = k * each; c < (k + 1) * each; ++c) s_[c] = z_[c] + Real(beta) * s_[c];
    });
  }
  throw Error(
      fmt::format("the pressure's residual is {:.3g} of its right side after {} iterations, expected at most {:.3g}",
                  report.residual, most_iterations_, tolerance_));
}

template class ConjugateGradients<float>;
template class ConjugateGradients<double>;

}  // namespace airlight::stable_fluids
