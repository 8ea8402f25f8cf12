#include "reference/stable_fluids/diffusion.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/base/error.h"

namespace airlight::stable_fluids {

template <class Real>
Diffusion<Real>::Diffusion(const Lattice& l, const Obstacles& obstacles, int axis, double tolerance, int most)
    : l_(l), obstacles_(obstacles), axis_(axis), tolerance_(tolerance), most_iterations_(most), box_(l, axis, false) {}

namespace {

// Adds the contribution of walls to the samples beside them: the transforms assume that all mirrored values are 0.
template <class Real>
void add_walls(const Lattice& l, Quantity quantity, double amount, const Field<Real>& field, const Size& begin,
               const Size& size, std::vector<Real>& values) {
  const double share = amount / (l.h * l.h);
  for (int a = 0; a < l.dimensions; ++a)
    for (int side = 0; side < 2; ++side) {
      if (beyond(l, field.axis, a, side) != Beyond::odd) continue;
      const bool on_faces = field.axis == a;
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      std::array<int, 3> at{};
      at[a] = side == 0 ? 0 : size[a] - 1;
      for (at[b] = 0; at[b] < size[b]; ++at[b])
        for (at[c] = 0; at[c] < size[c]; ++at[c]) {
          Vec3 cells = Vec3::Zero();
          cells[a] = side == 0 ? 0 : l.n[a];
          for (const int other : {b, c}) cells[other] = begin[other] + at[other] + field.offset(other);
          const double wall = value_at_side(l, field.axis, quantity, a, side, cells);
          values[at[0] + std::size_t(size[0]) * (at[1] + std::size_t(size[1]) * at[2])] +=
              Real((on_faces ? 1 : 2) * share * wall);
        }
    }
}

}  // namespace

template <class Real>
int Diffusion<Real>::operator()(Field<Real>& field, Quantity quantity, double amount) {
  if (!(amount > 0)) return 0;
  int iterations = 0;
  if (obstacles_.any()) {
    fill_ghosts(field, quantity, l_);
    iterations = solve_among_obstacles(field, quantity, amount);
  } else if (count_of(box_.size()) > 0) {  // else all samples are on walls
    const Size n = box_.size(), begin = box_.begin();
    values_.resize(count_of(n));
    const auto rows = [&](const auto& body) {
      for_rows(n, [&](int j, int k) {
        body(field.row(j + begin[1], k + begin[2]) + begin[0],
             values_.data() + std::size_t(n[0]) * (j + std::size_t(n[1]) * k));
      });
    };
    rows([&](const Real* samples, Real* values) { std::copy_n(samples, n[0], values); });
    add_walls(l_, quantity, amount, field, begin, n, values_);
    box_.solve(values_, 1, amount);
    rows([&](Real* samples, const Real* values) { std::copy_n(values, n[0], samples); });
  }
  fill_ghosts(field, quantity, l_);
  return iterations;
}

namespace {

// The operator among obstacles, on fields with ghosts: velocities are 0 on solid cells' faces, and nothing diffuses into
// them of what is at centres.
template <class Real>
class AmongObstacles {
 public:
  AmongObstacles(const Lattice& l, const Obstacles& obstacles, const Field<Real>& like, double amount)
      : l_(l), obstacles_(obstacles), share_(Real(amount / (l.h * l.h))), weight_(like) {
    each([&](int i, int j, int k) { weight_.at(i, j, k) = Real(weight_of(i, j, k)); });
  }

  // y = x - amount Laplacian x where a sample is unknown, 0 elsewhere; x with its ghosts.
  void apply(const Field<Real>& x, Field<Real>& y) const {
    each([&](int i, int j, int k) {
      const Real here = x.at(i, j, k);
      Real sum = 0;
      if (weight_.at(i, j, k) > 0)
        for (int a = 0; a < l_.dimensions; ++a)
          for (const int way : {-1, 1}) {
            const std::ptrdiff_t to = x.first + i + j * x.stride[1] + k * x.stride[2] + way * x.stride[a];
            if (x.axis == at_centers && obstacles_.solid.values[to]) continue;
            sum += here - x.values[to];
          }
      y.at(i, j, k) = weight_.at(i, j, k) > 0 ? here + share_ * sum : Real(0);
    });
  }

  // With the weights that make the operator symmetric: a sample on an open side stands for half a cell.
  double dot(const Field<Real>& a, const Field<Real>& b) const {
    const int slabs = weight_.n[2] > 1 ? weight_.n[2] : weight_.n[1];
    std::vector<double> sums(slabs, 0.0);
    each([&](int i, int j, int k) {
      sums[weight_.n[2] > 1 ? k : j] += double(weight_.at(i, j, k)) * double(a.at(i, j, k)) * double(b.at(i, j, k));
    });
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum;
  }

  double greatest(const Field<Real>& a) const {
    double most = 0;
    for (int k = 0; k < a.n[2]; ++k)
      for (int j = 0; j < a.n[1]; ++j)
        for (int i = 0; i < a.n[0]; ++i)
          if (weight_.at(i, j, k) > 0) most = std::max(most, std::abs(double(a.at(i, j, k))));
    return most;
  }

  bool known(int i, int j, int k) const { return !(weight_.at(i, j, k) > 0); }

  template <class Body>
  void each(const Body& body) const {
    for_rows(weight_.n, [&](int j, int k) {
      for (int i = 0; i < weight_.n[0]; ++i) body(i, j, k);
    });
  }

 private:
  double weight_of(int i, int j, int k) const {
    if (weight_.axis == at_centers) return obstacles_.solid.at(i, j, k) ? 0 : 1;
    const int a = weight_.axis, at = a == 0 ? i : a == 1 ? j : k;
    if (beside_solid(obstacles_, weight_, i, j, k)) return 0;
    if (!on_side(weight_, a, at, l_)) return 1;
    return l_.sides[a][at == 0 ? 0 : 1].kind == scene::Side::Kind::open ? 0.5 : 0;
  }

  const Lattice& l_;
  const Obstacles& obstacles_;
  Real share_;
  Field<Real> weight_;  // 0: known
};

}  // namespace

template <class Real>
int Diffusion<Real>::solve_among_obstacles(Field<Real>& x, Quantity quantity, double amount) {
  const AmongObstacles<Real> op(l_, obstacles_, x, amount);
  Field<Real> r(l_, x.axis), s(l_, x.axis), q(l_, x.axis);
  const double goal = tolerance_ * op.greatest(x);
  op.apply(x, q);
  op.each([&](int i, int j, int k) {
    s.at(i, j, k) = r.at(i, j, k) = op.known(i, j, k) ? Real(0) : x.at(i, j, k) - q.at(i, j, k);
  });
  double rr = op.dot(r, r);
  for (int iteration = 0; iteration <= most_iterations_; ++iteration) {
    if (op.greatest(r) <= goal) return iteration;
    fill_ghosts(s, quantity, l_, Walls::zero);
    op.apply(s, q);
    const double way = rr / op.dot(s, q);
    op.each([&](int i, int j, int k) {
      x.at(i, j, k) += Real(way) * s.at(i, j, k);
      r.at(i, j, k) -= Real(way) * q.at(i, j, k);
    });
    const double next = op.dot(r, r), beta = next / rr;
    rr = next;
    op.each([&](int i, int j, int k) { s.at(i, j, k) = r.at(i, j, k) + Real(beta) * s.at(i, j, k); });
  }
  throw Error(fmt::format("diffusion has not converged after {} iterations", most_iterations_));
}

template class Diffusion<float>;
template class Diffusion<double>;

}  // namespace airlight::stable_fluids
