#include "reference/stable_fluids/transforms.h"

#include <fftw3.h>

#include <cmath>
#include <mutex>

namespace airlight::stable_fluids {
namespace {

// One axis: how it is transformed, there and back.
struct AxisRule {
  int count, begin;  // unknown samples, and the first of them
  fftw_r2r_kind there, back;
  double length;              // logical: there and back multiplies by it
  std::vector<double> angle;  // of each coefficient
};

AxisRule rule_of(const Lattice& l, int axis_of_field, bool pressure, int axis) {
  const int n = l.n[axis];
  const bool faces = axis_of_field == axis;
  Beyond low = beyond(l, axis_of_field, axis, 0), high = beyond(l, axis_of_field, axis, 1);
  if (pressure) {
    const auto of = [&](int side) {
      return l.periodic(axis)                                      ? Beyond::periodic
             : l.sides[axis][side].kind == scene::Side::Kind::open ? Beyond::odd
                                                                   : Beyond::even;
    };
    low = of(0);
    high = of(1);
  }
  AxisRule r{n, 0, FFTW_R2HC, FFTW_HC2R, double(n), {}};
  double first = 0;  // angle of coefficient k is pi (k + first) / half of the length
  if (low == Beyond::periodic) {
    for (int k = 0; k < n; ++k) r.angle.push_back(2 * pi * std::min(k, n - k) / n);
    return r;
  }
  const bool odd_low = low == Beyond::odd, odd_high = high == Beyond::odd;
  r.length = 2 * n;
  if (!faces) {
    if (!odd_low && !odd_high) r.there = FFTW_REDFT10, r.back = FFTW_REDFT01, first = 0;
    if (odd_low && odd_high) r.there = FFTW_RODFT10, r.back = FFTW_RODFT01, first = 1;
    if (!odd_low && odd_high) r.there = r.back = FFTW_REDFT11, first = 0.5;
    if (odd_low && !odd_high) r.there = r.back = FFTW_RODFT11, first = 0.5;
  } else {
    if (!odd_low && !odd_high) r.there = r.back = FFTW_REDFT00, first = 0, r.count = n + 1;
    if (odd_low && odd_high) r.there = r.back = FFTW_RODFT00, first = 1, r.count = n - 1, r.begin = 1;
    if (!odd_low && odd_high) r.there = FFTW_REDFT01, r.back = FFTW_REDFT10, first = 0.5;
    if (odd_low && !odd_high) r.there = FFTW_RODFT01, r.back = FFTW_RODFT10, first = 0.5, r.begin = 1;
  }
  for (int k = 0; k < r.count; ++k) r.angle.push_back(pi * (k + first) / n);
  return r;
}

// FFTW in the precision that is asked for. Its planner is not safe to call from several threads.
std::mutex planner;
template <class Real>
struct Fftw;
template <>
struct Fftw<double> {
  using Plan = fftw_plan;
  static Plan many(int n, int howmany, int stride, int distance, fftw_r2r_kind kind, double* at) {
    return fftw_plan_many_r2r(1, &n, howmany, at, nullptr, stride, distance, at, nullptr, stride, distance, &kind,
                              FFTW_ESTIMATE | FFTW_UNALIGNED);
  }
  static void run(Plan p, double* at) { fftw_execute_r2r(p, at, at); }
  static void destroy(Plan p) { fftw_destroy_plan(p); }
};
template <>
struct Fftw<float> {
  using Plan = fftwf_plan;
  static Plan many(int n, int howmany, int stride, int distance, fftw_r2r_kind kind, float* at) {
    return fftwf_plan_many_r2r(1, &n, howmany, at, nullptr, stride, distance, at, nullptr, stride, distance, &kind,
                               FFTW_ESTIMATE | FFTW_UNALIGNED);
  }
  static void run(Plan p, float* at) { fftwf_execute_r2r(p, at, at); }
  static void destroy(Plan p) { fftwf_destroy_plan(p); }
};

}  // namespace

// Estimated, not measured, so that the same problem takes the same path everywhere and gives the same bits; for one slab
// each, so that they are the same for any number of threads.
template <class Real>
struct Helmholtz<Real>::Plans {
  typename Fftw<Real>::Plan there[3]{}, back[3]{};
  ~Plans() {
    const std::lock_guard lock(planner);
    for (int a = 0; a < 3; ++a) {
      if (there[a]) Fftw<Real>::destroy(there[a]);
      if (back[a]) Fftw<Real>::destroy(back[a]);
    }
  }
};

template <class Real>
Helmholtz<Real>::Helmholtz(const Lattice& l, int axis_of_field, bool pressure)
    : size_{1, 1, 1}, begin_{}, used_(l.dimensions), plans_(std::make_unique<Plans>()) {
  std::array<AxisRule, 3> rules;
  for (int a = 0; a < used_; ++a) {
    rules[a] = rule_of(l, axis_of_field, pressure, a);
    size_[a] = rules[a].count;
    begin_[a] = rules[a].begin;
    scale_ /= rules[a].length;
    for (const double angle : rules[a].angle) {
      const double s = std::sin(angle / 2);
      eigen_[a].push_back(4 * s * s / (l.h * l.h));
    }
  }
  for (int a = used_; a < 3; ++a) eigen_[a] = {0};
  if (count_of(size_) == 0) return;
  const int nx = size_[0], ny = size_[1];
  std::vector<Real> scratch(count_of(size_));
  const std::lock_guard lock(planner);
  const auto plan = [&](int a, int howmany, int stride, int distance) {
    plans_->there[a] = Fftw<Real>::many(size_[a], howmany, stride, distance, rules[a].there, scratch.data());
    plans_->back[a] = Fftw<Real>::many(size_[a], howmany, stride, distance, rules[a].back, scratch.data());
  };
  plan(0, ny, 1, nx);                       // the rows of a slab
  plan(1, nx, nx, 1);                       // its columns
  if (used_ == 3) plan(2, nx, nx * ny, 1);  // the columns through all slabs above a row
}

template <class Real>
Helmholtz<Real>::~Helmholtz() = default;
template <class Real>
Helmholtz<Real>::Helmholtz(Helmholtz&&) noexcept = default;

template <class Real>
void Helmholtz<Real>::solve(std::vector<Real>& values, double a, double b) const {
  if (count_of(size_) == 0) return;
  const int nx = size_[0], ny = size_[1], nz = size_[2];
  const std::ptrdiff_t slab = std::ptrdiff_t(nx) * ny;
  const auto divide = [&](Real* row, int j, int k) {
    const double other = eigen_[1][j] + eigen_[2][k];
    for (int i = 0; i < nx; ++i) {
      const double divisor = a + b * (eigen_[0][i] + other);
      row[i] = divisor > 0 ? Real(row[i] * (scale_ / divisor)) : Real(0);
    }
  };
  for_each(nz, [&](int k) {
    Real* at = values.data() + k * slab;
    Fftw<Real>::run(plans_->there[0], at);
    Fftw<Real>::run(plans_->there[1], at);
    if (used_ == 3) return;
    for (int j = 0; j < ny; ++j) divide(at + j * std::ptrdiff_t(nx), j, k);
    Fftw<Real>::run(plans_->back[1], at);
    Fftw<Real>::run(plans_->back[0], at);
  });
  if (used_ < 3) return;
  for_each(ny, [&](int j) {
    Real* at = values.data() + j * std::ptrdiff_t(nx);
    Fftw<Real>::run(plans_->there[2], at);
    for (int k = 0; k < nz; ++k) divide(at + k * slab, j, k);
    Fftw<Real>::run(plans_->back[2], at);
  });
  for_each(nz, [&](int k) {
    Real* at = values.data() + k * slab;
    Fftw<Real>::run(plans_->back[1], at);
    Fftw<Real>::run(plans_->back[0], at);
  });
}

template class Helmholtz<float>;
template class Helmholtz<double>;

}  // namespace airlight::stable_fluids
