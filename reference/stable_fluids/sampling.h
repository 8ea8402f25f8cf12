// Reading a field between its samples, and finding where what arrives at a place came from. For kernels: no checks.
#pragma once
#include <algorithm>
#include <cmath>

#include "reference/stable_fluids/obstacles.h"

namespace airlight::stable_fluids {

template <class Real>
using Cells = std::array<Real, 3>;  // a place [cells]

// The sample before a coordinate that is at least -1, and the share of the way to the next.
template <class Real>
struct Between {
  int i;
  Real share;
  explicit Between(Real x) : i(int(x)) {
    i -= x < Real(i);
    share = x - Real(i);
  }
};

// Cubic through b and c with slopes limited so that it stays between them: Fedkiw et al. 2001, appendix B, and the
// factor of Fritsch and Carlson 1980.
template <class Real>
Real monotone_cubic(Real a, Real b, Real c, Real d, Real t) {
  const Real rise = c - b;
  const auto limited = [&](Real slope) {
    return rise > 0 ? std::clamp(slope, Real(0), 3 * rise) : std::clamp(slope, 3 * rise, Real(0));
  };
  const Real before = limited((c - a) / 2), after = limited((d - b) / 2);
  return b + t * (before + t * (3 * rise - 2 * before - after + t * (before + after - 2 * rise)));
}

template <class Real, int D>
struct Sampler {
  const Real* origin;
  std::ptrdiff_t sy, sz;
  Real offset[3];

  explicit Sampler(const Field<Real>& f)
      : origin(f.values.data() + f.first),
        sy(f.stride[1]),
        sz(f.stride[2]),
        offset{Real(f.offset(0)), Real(f.offset(1)), Real(f.offset(2))} {}

  // The corner before a place and the shares beyond it.
  struct Foot {
    const Real* at;
    Real x, y, z;
  };
  Foot foot(const Cells<Real>& p) const {
    const Between<Real> x(p[0] - offset[0]), y(p[1] - offset[1]);
    if constexpr (D == 2) return {origin + x.i + y.i * sy, x.share, y.share, 0};
    const Between<Real> z(p[2] - offset[2]);
    return {origin + x.i + y.i * sy + z.i * sz, x.share, y.share, z.share};
  }

  Real linear(const Foot& f) const {
    const auto row = [&](const Real* at) { return at[0] + f.x * (at[1] - at[0]); };
    const auto slab = [&](const Real* at) {
      const Real low = row(at);
      return low + f.y * (row(at + sy) - low);
    };
    const Real low = slab(f.at);
    if constexpr (D == 2) return low;
    return low + f.z * (slab(f.at + sz) - low);
  }
  Real linear(const Cells<Real>& p) const { return linear(foot(p)); }

  Real cubic(const Foot& f) const {
    const auto row = [&](const Real* at) { return monotone_cubic(at[-1], at[0], at[1], at[2], f.x); };
    const auto slab = [&](const Real* at) {
      return monotone_cubic(row(at - sy), row(at), row(at + sy), row(at + 2 * sy), f.y);
    };
    if constexpr (D == 2) return slab(f.at);
    return monotone_cubic(slab(f.at - sz), slab(f.at), slab(f.at + sz), slab(f.at + 2 * sz), f.z);
  }

  // Least and greatest of the samples around a place.
  std::pair<Real, Real> range(const Foot& f) const {
    Real least = f.at[0], greatest = f.at[0];
    for (int k = 0; k < (D == 2 ? 1 : 2); ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const Real value = f.at[i + j * sy + k * sz];
          least = std::min(least, value);
          greatest = std::max(greatest, value);
        }
    return {least, greatest};
  }
};

// Where what arrives at a place was a time ago, the velocity being the same all the while.
template <class Real, int D>
class Tracer {
 public:
  // `cells` is the time over h: velocities times it are ways in cells. Negative: where it will be.
  Tracer(const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, double cells, int order)
      : u_{Sampler<Real, D>(u[0]), Sampler<Real, D>(u[1]), Sampler<Real, D>(u[D == 2 ? 1 : 2])},
        l_(l),
        obstacles_(obstacles),
        cells_(Real(cells)),
        order_(order) {
    for (int a = 0; a < 3; ++a) {
      n_[a] = Real(l.n[a]);
      wraps_[a] = l.periodic(a);
    }
  }

  Cells<Real> foot(const Cells<Real>& p) const {
    const Cells<Real> first = way(p);
    Cells<Real> total = first;
    if (order_ == 2) total = way(inside(minus(p, first, Real(0.5))));
    if (order_ == 4) {
      const Cells<Real> second = way(inside(minus(p, first, Real(0.5))));
      const Cells<Real> third = way(inside(minus(p, second, Real(0.5))));
      const Cells<Real> fourth = way(inside(minus(p, third, Real(1))));
      for (int a = 0; a < D; ++a) total[a] = (first[a] + 2 * (second[a] + third[a]) + fourth[a]) / 6;
    }
    Cells<Real> q = minus(p, total, Real(1));
    if (obstacles_.any()) {
      // Not through what is solid; a wall ends the way first.
      for (int a = 0; a < D; ++a)
        if (!wraps_[a]) q[a] = q[a] > 0 ? std::min(q[a], n_[a]) : Real(0);
      const Vec3 end = until_solid(obstacles_, l_, Vec3(p[0], p[1], p[2]), Vec3(q[0], q[1], q[2]));
      for (int a = 0; a < D; ++a) q[a] = Real(end[a]);
    }
    return inside(q);
  }

 private:
  Cells<Real> way(const Cells<Real>& p) const {
    Cells<Real> v{cells_ * u_[0].linear(p), cells_ * u_[1].linear(p), 0};
    if constexpr (D == 3) v[2] = cells_ * u_[2].linear(p);
    return v;
  }
  Cells<Real> minus(const Cells<Real>& p, const Cells<Real>& v, Real share) const {
    Cells<Real> q = p;
    for (int a = 0; a < D; ++a) q[a] -= share * v[a];
    return q;
  }
  // Within the box whatever comes: what is not finite, or too far away to be wrapped, is at its low side.
  Cells<Real> inside(Cells<Real> p) const {
    for (int a = 0; a < D; ++a) {
      if (wraps_[a]) {
        p[a] -= n_[a] * std::floor(p[a] / n_[a]);
        if (!(p[a] >= 0 && p[a] < n_[a])) p[a] = 0;
      } else {
        p[a] = p[a] > 0 ? std::min(p[a], n_[a]) : Real(0);
      }
    }
    return p;
  }

  Sampler<Real, D> u_[3];
  const Lattice& l_;
  const Obstacles& obstacles_;
  Real cells_, n_[3];
  bool wraps_[3];
  int order_;
};

}  // namespace airlight::stable_fluids
