#include "reference/stable_fluids/advection.h"

#include <algorithm>
#include <cmath>

#include "reference/stable_fluids/sampling.h"

namespace airlight::stable_fluids {
namespace {

template <class Real, int D>
class Transport {
 public:
  using V = Vector<Real>;

  Transport(const Advection& how, const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, double dt,
            const Field<Real>& from)
      : how_(how),
        obstacles_(obstacles),
        from_(from),
        back_(l, obstacles, u, from.axis, dt / l.h, how.trace),
        forth_(l, obstacles, u, from.axis, -dt / l.h, how.trace) {}

  // Carries the values at the feet; with `range`, also the least and greatest of the samples around the feet.
  void carry(const Field<Real>& source, Field<Real>& to, Range<Real>* range = nullptr) const {
    const Sampler<Real, D> samples(source);
    each([&](const Block& b) {
      const auto foot = samples.foot(back_.feet(b.i, b.j, b.k, b.p));
      if (!range) return store(b, read(samples, source, foot, b), to);
      Read<Real> at_foot = samples.linear_in_range(foot);
      store(b, at_foot.least, range->least);
      store(b, at_foot.greatest, range->greatest);
      const bool plain = how_.interpolation == Interpolation::linear && !obstacles_.any();
      store(b, plain ? at_foot.value : read(samples, source, foot, b), to);
    });
  }

  // Half of what going there and back changes is taken off: MacCormack, from the values that arrived.
  void correct(const Field<Real>& arrived, const Range<Real>& range, Field<Real>& to) const {
    const Sampler<Real, D> samples(arrived);
    each([&](const Block& b) {
      const V returned = read(samples, arrived, samples.foot(forth_.feet(b.i, b.j, b.k, b.p)), b);
      const V first = load(b, arrived), change = all(Real(0.5)) * (load(b, from_) - returned);
      store(b, limited(first + change, first, range, b), to);
    });
  }

  // First half of BFECC: half of the change of a round trip is subtracted from the values before they are carried.
  void compensate(const Field<Real>& arrived, Field<Real>& to) const {
    const Sampler<Real, D> samples(arrived);
    each([&](const Block& b) {
      const V now = load(b, from_), returned = read(samples, arrived, samples.foot(forth_.feet(b.i, b.j, b.k, b.p)), b);
      store(b, now + all(Real(0.5)) * (now - returned), to);
    });
  }
  // Second half of BFECC, limited like MacCormack.
  void limit(const Field<Real>& arrived, const Range<Real>& range, Field<Real>& to) const {
    each([&](const Block& b) { store(b, limited(load(b, to), load(b, arrived), range, b), to); });
  }

 private:
  // Samples side by side along x.
  struct Block {
    int i, j, k, count;
    std::ptrdiff_t place;  // of the first
    Places<Real> p;
  };

  template <class Body>
  void each(const Body& body) const {
    const int lanes = int(hn::Lanes(Lanes<Real>()));
    for_rows(from_.n, [&](int j, int k) {
      Block b{0, j, k, lanes, 0, {}};
      b.p[1] = all(Real(j + from_.offset(1)));
      b.p[2] = all(Real(k + from_.offset(2)));
      const std::ptrdiff_t row = from_.first + j * from_.stride[1] + k * from_.stride[2];
      for (b.i = 0; b.i < from_.n[0]; b.i += lanes) {
        b.count = std::min(lanes, from_.n[0] - b.i);
        b.place = row + b.i;
        b.p[0] = hn::Iota(Lanes<Real>(), Real(b.i + from_.offset(0)));
        body(b);
      }
    });
  }

  V load(const Block& b, const Field<Real>& f) const { return hn::LoadU(Lanes<Real>(), f.values.data() + b.place); }
  void store(const Block& b, V value, Field<Real>& f) const { store(b, value, f.values); }
  void store(const Block& b, V value, std::vector<Real>& values) const {
    Real* to = values.data() + b.place;
    if (b.count == int(hn::Lanes(Lanes<Real>()))) return hn::StoreU(value, Lanes<Real>(), to);
    Real lanes[64];
    hn::StoreU(value, Lanes<Real>(), lanes);
    std::copy_n(lanes, b.count, to);
  }

  V limited(V value, V first, const Range<Real>& range, const Block& b) const {
    if (how_.limiter == Limiter::none) return value;
    const V least = hn::LoadU(Lanes<Real>(), range.least.data() + b.place);
    const V greatest = hn::LoadU(Lanes<Real>(), range.greatest.data() + b.place);
    if (how_.limiter == Limiter::clamp) return Min(Max(value, least), greatest);
    return IfThenElse(Or(value > greatest, value < least), first, value);
  }

  V read(const Sampler<Real, D>& samples, const Field<Real>& source, const typename Sampler<Real, D>::Foot& foot,
         const Block& b) const {
    const V value = how_.interpolation == Interpolation::cubic ? samples.cubic(foot) : samples.linear(foot);
    return obstacles_.any() && from_.axis == at_centers ? in_fluid(value, source, foot, b) : value;
  }

  // Interpolates between the fluid samples around a point only, so that nothing passes an obstacle of one cell.
  V in_fluid(V value, const Field<Real>& source, const typename Sampler<Real, D>::Foot& foot, const Block& b) const {
    Real values[64], x[64], y[64], z[64];
    hn::StoreU(value, Lanes<Real>(), values);
    hn::StoreU(foot.x, Lanes<Real>(), x);
    hn::StoreU(foot.y, Lanes<Real>(), y);
    hn::StoreU(foot.z, Lanes<Real>(), z);
    for (int lane = 0; lane < b.count; ++lane) {
      if (obstacles_.solid.values[b.place + lane])
        values[lane] = 0;
      else
        read_in_fluid(source, source.first + foot.at[lane], {x[lane], y[lane], z[lane]}, values[lane]);
    }
    return hn::LoadU(Lanes<Real>(), values);
  }
  void read_in_fluid(const Field<Real>& source, std::ptrdiff_t at, const std::array<Real, 3>& share,
                     Real& value) const {
    const std::uint8_t* solid = obstacles_.solid.values.data() + at;
    Real sum = 0, weights = 0;
    bool any = false;
    for (int k = 0; k < (D == 2 ? 1 : 2); ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const std::ptrdiff_t to = i + j * source.stride[1] + k * source.stride[2];
          if (solid[to]) {
            any = true;
            continue;
          }
          const Real weight = (i ? share[0] : 1 - share[0]) * (j ? share[1] : 1 - share[1]) *
                              (D == 2 ? Real(1)
                               : k    ? share[2]
                                      : 1 - share[2]);
          sum += weight * source.values[at + to];
          weights += weight;
        }
    if (any) value = weights > 0 ? sum / weights : Real(0);
  }

  const Advection& how_;
  const Obstacles& obstacles_;
  const Field<Real>& from_;
  Tracer<Real, D> back_, forth_;
};

template <class Real, int D>
void advect_in(const Advection& how, const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, double dt,
               Quantity quantity, const Field<Real>& from, Field<Real>& to, Workspace<Real>& work) {
  const Transport<Real, D> transport(how, l, obstacles, u, dt, from);
  if (how.scheme == Scheme::semi_lagrangian) return transport.carry(from, to);
  work.shape_as(from, how.scheme);
  transport.carry(from, to, &work.range);
  const Walls walls = quantity == Quantity::velocity ? Walls::as_they_are : Walls::carried;
  fill_ghosts(to, quantity, l, walls);
  if (how.scheme == Scheme::maccormack) {
    transport.correct(to, work.range, work.first);
  } else {
    transport.compensate(to, work.second);
    fill_ghosts(work.second, quantity, l, walls);
    transport.carry(work.second, work.first);
    transport.limit(to, work.range, work.first);
  }
  std::swap(to.values, work.first.values);
}

}  // namespace

template <class Real>
void Workspace<Real>::shape_as(const Field<Real>& from, Scheme scheme) {
  const auto fit = [&](Field<Real>& field) {
    if (field.axis != from.axis || field.values.size() != from.values.size()) field = from;
  };
  fit(first);
  if (scheme == Scheme::bfecc) fit(second);
  range.least.resize(from.values.size());
  range.greatest.resize(from.values.size());
}

template <class Real>
void advect(const Advection& how, const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, double dt,
            Quantity quantity, const Field<Real>& from, Field<Real>& to, Workspace<Real>& work) {
  if (l.dimensions == 2)
    advect_in<Real, 2>(how, l, obstacles, u, dt, quantity, from, to, work);
  else
    advect_in<Real, 3>(how, l, obstacles, u, dt, quantity, from, to, work);
}

template <class Real>
double interpolate(const Field<Real>& field, const Lattice& l, const Vec3& cells) {
  Places<Real> p{all(Real(0)), all(Real(0)), all(Real(0))};
  for (int a = 0; a < l.dimensions; ++a) {
    const double n = l.n[a];
    double x = l.periodic(a) ? cells[a] - n * std::floor(cells[a] / n) : std::clamp(cells[a], 0.0, n);
    if (!(x < n) && l.periodic(a)) x = 0;
    p[a] = all(Real(x));
  }
  return hn::GetLane(l.dimensions == 2 ? Sampler<Real, 2>(field).linear(p) : Sampler<Real, 3>(field).linear(p));
}

#define AIRLIGHT_OF(Real)                                                                                           \
  template struct Workspace<Real>;                                                                                  \
  template void advect(const Advection&, const Lattice&, const Obstacles&, const Velocity<Real>&, double, Quantity, \
                       const Field<Real>&, Field<Real>&, Workspace<Real>&);                                         \
  template double interpolate(const Field<Real>&, const Lattice&, const Vec3&);
AIRLIGHT_OF(float)
AIRLIGHT_OF(double)
#undef AIRLIGHT_OF

}  // namespace airlight::stable_fluids
