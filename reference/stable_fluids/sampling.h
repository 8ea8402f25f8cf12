// Interpolation of a field between its samples, and back-tracing: where the content of a point came from. Works on as
// many points at once as a vector has lanes. Kernels do not check arguments. Results are bitwise equal for any vector
// width: no operation is fused.
#pragma once
#include <hwy/highway.h>

#include <array>

#include "reference/stable_fluids/obstacles.h"

namespace airlight::stable_fluids {

namespace hn = hwy::HWY_NAMESPACE;

template <class Real>
using Lanes = hn::ScalableTag<Real>;
template <class Real>
using Vector = hn::Vec<Lanes<Real>>;
template <class Real>
using Places = std::array<Vector<Real>, 3>;  // [cells]

template <class Real>
Vector<Real> all(Real x) {
  return hn::Set(Lanes<Real>(), x);
}

// a + t (b - a): a where t is 0, and where both are the same.
template <class V>
V between(V a, V b, V t) {
  return a + t * (b - a);
}

// Cubic through b and c with slopes limited so that it stays between them: Fedkiw et al. 2001, appendix B, and the
// factor of Fritsch and Carlson 1980.
template <class Real>
Vector<Real> monotone_cubic(Vector<Real> a, Vector<Real> b, Vector<Real> c, Vector<Real> d, Vector<Real> t) {
  const auto zero = all(Real(0)), half = all(Real(0.5)), two = all(Real(2)), three = all(Real(3));
  const auto rise = c - b, most = three * rise;
  const auto limited = [&](Vector<Real> slope) { return Max(Min(slope, Max(most, zero)), Min(most, zero)); };
  const auto before = limited(half * (c - a)), after = limited(half * (d - b));
  const auto cube = before + after - two * rise;
  const auto square = most - two * before - after;
  return b + t * (before + t * (square + t * cube));
}

// Interpolated values, and the least and greatest of the samples around.
template <class Real>
struct Read {
  Vector<Real> value, least, greatest;
};

template <class Real, int D>
class Sampler {
 public:
  using V = Vector<Real>;
  using Index = hn::TFromD<hn::RebindToSigned<Lanes<Real>>>;

  // The samples before places, as distances from the first one, and the shares beyond them.
  struct Foot {
    Index at[hn::MaxLanes(Lanes<Real>())];
    V x, y, z;
  };

  explicit Sampler(const Field<Real>& f) : origin_(f.values.data() + f.first), stride_(f.stride) {
    for (int a = 0; a < 3; ++a) offset_[a] = Real(f.offset(a));
  }

  Foot foot(const Places<Real>& p) const {
    const auto x = split(p[0], 0), y = split(p[1], 1);
    const auto z = D == 2 ? std::pair(all(Real(0)), all(Real(0))) : split(p[2], 2);
    Foot f{{}, x.second, y.second, z.second};
    hn::StoreU(index(x.first, y.first, z.first), hn::RebindToSigned<Lanes<Real>>(), f.at);
    return f;
  }

  V linear(const Foot& f) const {
    const auto row = [&](std::ptrdiff_t to) {
      const auto [first, second] = get(f, to);
      return between(first, second, f.x);
    };
    const auto slab = [&](std::ptrdiff_t to) { return between(row(to), row(to + stride_[1]), f.y); };
    if constexpr (D == 2) return slab(0);
    return between(slab(0), slab(stride_[2]), f.z);
  }
  V linear(const Places<Real>& p) const { return linear(foot(p)); }

  V cubic(const Foot& f) const {
    const auto row = [&](std::ptrdiff_t to) {
      const auto [a, b] = get(f, to - 1);
      const auto [c, d] = get(f, to + 1);
      return monotone_cubic<Real>(a, b, c, d, f.x);
    };
    const auto slab = [&](std::ptrdiff_t to) {
      const std::ptrdiff_t s = stride_[1];
      return monotone_cubic<Real>(row(to - s), row(to), row(to + s), row(to + 2 * s), f.y);
    };
    const std::ptrdiff_t s = stride_[2];
    if constexpr (D == 2) return slab(0);
    return monotone_cubic<Real>(slab(-s), slab(0), slab(s), slab(2 * s), f.z);
  }

  // With the range of the samples around. A sample of weight 0 does not count: at a place on a line of samples the one
  // after it would, and the one before it would not.
  Read<Real> linear_in_range(const Foot& f) const {
    const auto row = [&](std::ptrdiff_t to) {
      const auto [first, second] = get(f, to);
      return combined(Read<Real>{first, first, first}, Read<Real>{second, second, second}, f.x);
    };
    const auto slab = [&](std::ptrdiff_t to) { return combined(row(to), row(to + stride_[1]), f.y); };
    if constexpr (D == 2) return slab(0);
    return combined(slab(0), slab(stride_[2]), f.z);
  }

 private:
  Read<Real> combined(const Read<Real>& first, const Read<Real>& second, V share) const {
    const auto weightless = share == all(Real(0));
    Read<Real> both;
    both.value = between(first.value, second.value, share);
    both.least = IfThenElse(weightless, first.least, Min(first.least, second.least));
    both.greatest = IfThenElse(weightless, first.greatest, Max(first.greatest, second.greatest));
    return both;
  }
  std::pair<V, V> split(V x, int axis) const {
    const V from = x - all(offset_[axis]), floor = Floor(from);
    return {floor, from - floor};
  }
  // Whole numbers of samples: exact in double, and as integers where a float would not be.
  auto index(V x, V y, V z) const {
    const hn::RebindToSigned<Lanes<Real>> integers;
    if constexpr (sizeof(Real) == 8) {
      const V rows = y * all(Real(stride_[1])), slabs = z * all(Real(stride_[2]));
      return hn::ConvertTo(integers, x + (rows + slabs));
    } else {
      const auto of = [&](V v) { return hn::ConvertTo(integers, v); };
      const auto step = [&](int a) { return hn::Set(integers, std::int32_t(stride_[a])); };
      return of(x) + (of(y) * step(1) + of(z) * step(2));
    }
  }
  // Two neighbours along x, as one load a lane: half as many as gathers, which some processors are slow at besides.
  std::pair<V, V> get(const Foot& f, std::ptrdiff_t to) const {
    constexpr std::size_t half = hn::MaxLanes(Lanes<Real>()) / 2;
    const auto low = neighbours<half>(origin_ + to, f.at), high = neighbours<half>(origin_ + to, f.at + half);
    return {hn::ConcatEven(Lanes<Real>(), high, low), hn::ConcatOdd(Lanes<Real>(), high, low)};
  }
  template <std::size_t Count>
  static auto neighbours(const Real* origin, const Index* at) {
    const hn::FixedTag<Real, 2 * Count> side_by_side;
    if constexpr (Count == 1)
      return hn::LoadU(side_by_side, origin + *at);
    else
      return hn::Combine(side_by_side, neighbours<Count / 2>(origin, at + Count / 2),
                         neighbours<Count / 2>(origin, at));
  }

  const Real* origin_;
  std::array<std::ptrdiff_t, 3> stride_;
  Real offset_[3];
};

// Where what arrives at samples of one kind of field was a time ago, the velocity being the same all the while.
template <class Real, int D>
class Tracer {
 public:
  using V = Vector<Real>;

  // For fields on the faces of `axis`, or at centres. `cells` is the time over h: velocities times it are ways in cells;
  // negative: where it will be.
  Tracer(const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, int axis, double cells, int order)
      : fields_(u),
        u_{Sampler<Real, D>(u[0]), Sampler<Real, D>(u[1]), Sampler<Real, D>(u[D == 2 ? 1 : 2])},
        l_(l),
        obstacles_(obstacles),
        axis_(axis),
        cells_(all(Real(cells))),
        order_(order) {}

  // Feet of the paths that end at the samples from (i, j, k) along x, at positions p.
  Places<Real> feet(int i, int j, int k, const Places<Real>& p) const {
    const Places<Real> first = way_at_samples(i, j, k);
    Places<Real> total = first;
    const auto half = all(Real(0.5)), one = all(Real(1));
    if (order_ == 2) total = way(inside(minus(p, first, half)));
    if (order_ == 4) {
      const Places<Real> second = way(inside(minus(p, first, half)));
      const Places<Real> third = way(inside(minus(p, second, half)));
      const Places<Real> fourth = way(inside(minus(p, third, one)));
      for (int a = 0; a < D; ++a) {
        const V middle = all(Real(2)) * (second[a] + third[a]);
        total[a] = all(Real(1) / 6) * (first[a] + middle + fourth[a]);
      }
    }
    Places<Real> q = minus(p, total, one);
    if (obstacles_.any()) q = before_solids(p, q);
    return inside(q);
  }

 private:
  // There no interpolation is needed: the mean of the faces around.
  Places<Real> way_at_samples(int i, int j, int k) const {
    Places<Real> v{all(Real(0)), all(Real(0)), all(Real(0))};
    for (int a = 0; a < D; ++a) {
      const Field<Real>& f = fields_[a];
      const Real* at = f.row(j, k) + i;
      const auto load = [&](std::ptrdiff_t to) { return hn::LoadU(Lanes<Real>(), at + to); };
      const std::ptrdiff_t along = f.stride[a];
      if (a == axis_) {
        v[a] = load(0);
      } else if (axis_ == at_centers) {
        v[a] = all(Real(0.5)) * (load(0) + load(along));
      } else {
        const std::ptrdiff_t before = -f.stride[axis_];
        v[a] = all(Real(0.25)) * (load(0) + load(along) + (load(before) + load(before + along)));
      }
      v[a] = cells_ * v[a];
    }
    return v;
  }

  Places<Real> way(const Places<Real>& p) const {
    Places<Real> v{cells_ * u_[0].linear(p), cells_ * u_[1].linear(p), all(Real(0))};
    if constexpr (D == 3) v[2] = cells_ * u_[2].linear(p);
    return v;
  }
  Places<Real> minus(const Places<Real>& p, const Places<Real>& v, V share) const {
    Places<Real> q = p;
    for (int a = 0; a < D; ++a) q[a] = p[a] - share * v[a];
    return q;
  }

  // Within the box whatever comes: what is not finite, or too far away to be wrapped, is at its low side.
  Places<Real> inside(const Places<Real>& p) const {
    Places<Real> q = p;
    const V zero = all(Real(0));
    for (int a = 0; a < D; ++a) {
      const V n = all(Real(l_.n[a]));
      if (l_.periodic(a)) {
        const V wrapped = p[a] - n * Floor(p[a] / n);
        q[a] = IfThenElseZero(And(wrapped >= zero, wrapped < n), wrapped);
      } else {
        q[a] = IfThenElseZero(p[a] > zero, Min(p[a], n));
      }
    }
    return q;
  }

  // Not through what is solid; a wall ends the way first. Ways shorter than to the next solid cell are left alone.
  Places<Real> before_solids(const Places<Real>& p, const Places<Real>& q) const {
    constexpr std::size_t most = 64;
    Real from[3][most], to[3][most];
    for (int a = 0; a < 3; ++a) {
      hn::StoreU(p[a], Lanes<Real>(), from[a]);
      hn::StoreU(q[a], Lanes<Real>(), to[a]);
    }
    for (std::size_t lane = 0; lane < hn::Lanes(Lanes<Real>()); ++lane) {
      Vec3 start = Vec3::Zero(), end = Vec3::Zero();
      double longest = 0;
      for (int a = 0; a < D; ++a) {
        start[a] = from[a][lane];
        end[a] = l_.periodic(a) ? to[a][lane] : to[a][lane] > 0 ? std::min(double(to[a][lane]), double(l_.n[a])) : 0;
        longest = std::max(longest, std::abs(end[a] - start[a]));
      }
      if (longest <= obstacles_.clear_around(l_, start)) continue;
      const Vec3 stop = until_solid(obstacles_, l_, start, end);
      for (int a = 0; a < D; ++a) to[a][lane] = Real(stop[a]);
    }
    Places<Real> result = q;
    for (int a = 0; a < D; ++a) result[a] = hn::LoadU(Lanes<Real>(), to[a]);
    return result;
  }

  const Velocity<Real>& fields_;
  Sampler<Real, D> u_[3];
  const Lattice& l_;
  const Obstacles& obstacles_;
  int axis_;
  V cells_;
  int order_;
};

}  // namespace airlight::stable_fluids
