#include "reference/stable_fluids/advection.h"

#include "reference/stable_fluids/sampling.h"

namespace airlight::stable_fluids {
namespace {

template <class Real, int D>
class Transport {
 public:
  Transport(const Advection& how, const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, double dt,
            const Field<Real>& from)
      : how_(how),
        l_(l),
        obstacles_(obstacles),
        from_(from),
        back_(l, obstacles, u, dt / l.h, how.trace),
        forth_(l, obstacles, u, -dt / l.h, how.trace) {}

  // What was at the feet in `source`.
  void carry(const Tracer<Real, D>& tracer, const Field<Real>& source, Field<Real>& to) const {
    const Sampler<Real, D> samples(source);
    each([&](const Cells<Real>& p, std::ptrdiff_t place) { to.values[place] = read(samples, tracer.foot(p), place); });
  }
  void back(const Field<Real>& source, Field<Real>& to) const { carry(back_, source, to); }

  // Half of what going there and back changes is taken off: MacCormack, from the values that arrived.
  void correct(const Field<Real>& arrived, Field<Real>& to) const {
    const Sampler<Real, D> samples(arrived), old(from_);
    each([&](const Cells<Real>& p, std::ptrdiff_t place) {
      const Real returned = read(samples, forth_.foot(p), place), first = arrived.values[place];
      const Real better = first + (from_.values[place] - returned) / 2;
      to.values[place] = how_.limiter == Limiter::none ? better : limited(better, first, old.foot(back_.foot(p)), old);
    });
  }

  // The same of the values that have yet to go: the first half of BFECC.
  void compensate(const Field<Real>& arrived, Field<Real>& to) const {
    const Sampler<Real, D> samples(arrived);
    each([&](const Cells<Real>& p, std::ptrdiff_t place) {
      const Real now = from_.values[place];
      to.values[place] = now + (now - read(samples, forth_.foot(p), place)) / 2;
    });
  }
  // And the second.
  void carry_limited(const Field<Real>& source, const Field<Real>& arrived, Field<Real>& to) const {
    const Sampler<Real, D> samples(source), old(from_);
    each([&](const Cells<Real>& p, std::ptrdiff_t place) {
      const Cells<Real> foot = back_.foot(p);
      const Real better = read(samples, foot, place);
      to.values[place] =
          how_.limiter == Limiter::none ? better : limited(better, arrived.values[place], old.foot(foot), old);
    });
  }

 private:
  template <class Body>
  void each(const Body& body) const {
    for_rows(from_.n, [&](int j, int k) {
      Cells<Real> p{0, Real(j + from_.offset(1)), Real(k + from_.offset(2))};
      const std::ptrdiff_t row = from_.first + j * from_.stride[1] + k * from_.stride[2];
      for (int i = 0; i < from_.n[0]; ++i) {
        p[0] = Real(i + from_.offset(0));
        body(p, row + i);
      }
    });
  }

  Real limited(Real value, Real first, const typename Sampler<Real, D>::Foot& foot, const Sampler<Real, D>& old) const {
    const auto [least, greatest] = old.range(foot);
    if (how_.limiter == Limiter::clamp) return std::clamp(value, least, greatest);
    return value < least || value > greatest ? first : value;
  }

  Real read(const Sampler<Real, D>& samples, const Cells<Real>& p, std::ptrdiff_t place) const {
    const auto foot = samples.foot(p);
    if (!obstacles_.any() || from_.axis != at_centers)
      return how_.interpolation == Interpolation::cubic ? samples.cubic(foot) : samples.linear(foot);
    return obstacles_.solid.values[place] ? Real(0) : in_fluid(samples, foot);
  }

  // Of the samples around a place those that are fluid: what is beyond an obstacle of one cell does not come through.
  Real in_fluid(const Sampler<Real, D>& samples, const typename Sampler<Real, D>::Foot& foot) const {
    const std::uint8_t* solid = obstacles_.solid.values.data() + from_.first + (foot.at - samples.origin);
    Real sum = 0, weights = 0;
    bool all = true;
    for (int k = 0; k < (D == 2 ? 1 : 2); ++k)
      for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
          const std::ptrdiff_t to = i + j * samples.sy + k * samples.sz;
          if (solid[to]) {
            all = false;
            continue;
          }
          const Real weight = (i ? foot.x : 1 - foot.x) * (j ? foot.y : 1 - foot.y) *
                              (D == 2 ? Real(1)
                               : k    ? foot.z
                                      : 1 - foot.z);
          sum += weight * foot.at[to];
          weights += weight;
        }
    if (all) return how_.interpolation == Interpolation::cubic ? samples.cubic(foot) : samples.linear(foot);
    return weights > 0 ? sum / weights : Real(0);
  }

  const Advection& how_;
  const Lattice& l_;
  const Obstacles& obstacles_;
  const Field<Real>& from_;
  Tracer<Real, D> back_, forth_;
};

template <class Real, int D>
void advect_in(const Advection& how, const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, double dt,
               Quantity quantity, const Field<Real>& from, Field<Real>& to, Field<Real>& spare) {
  const Transport<Real, D> transport(how, l, obstacles, u, dt, from);
  transport.back(from, to);
  if (how.scheme == Scheme::semi_lagrangian) return;
  fill_ghosts(to, quantity, l);
  if (how.scheme == Scheme::maccormack) {
    transport.correct(to, spare);
    std::swap(to.values, spare.values);
    return;
  }
  Field<Real> compensated = from;
  transport.compensate(to, compensated);
  fill_ghosts(compensated, quantity, l);
  transport.carry_limited(compensated, to, spare);
  std::swap(to.values, spare.values);
}

}  // namespace

template <class Real>
void advect(const Advection& how, const Lattice& l, const Obstacles& obstacles, const Velocity<Real>& u, double dt,
            Quantity quantity, const Field<Real>& from, Field<Real>& to, Field<Real>& spare) {
  if (l.dimensions == 2)
    advect_in<Real, 2>(how, l, obstacles, u, dt, quantity, from, to, spare);
  else
    advect_in<Real, 3>(how, l, obstacles, u, dt, quantity, from, to, spare);
}

template <class Real>
double interpolate(const Field<Real>& field, const Lattice& l, const Vec3& cells) {
  Cells<Real> p{};
  for (int a = 0; a < l.dimensions; ++a) {
    const double n = l.n[a];
    double x = l.periodic(a) ? cells[a] - n * std::floor(cells[a] / n) : std::clamp(cells[a], 0.0, n);
    if (!(x < n) && l.periodic(a)) x = 0;
    p[a] = Real(x);
  }
  return l.dimensions == 2 ? Sampler<Real, 2>(field).linear(p) : Sampler<Real, 3>(field).linear(p);
}

template void advect(const Advection&, const Lattice&, const Obstacles&, const Velocity<float>&, double, Quantity,
                     const Field<float>&, Field<float>&, Field<float>&);
template void advect(const Advection&, const Lattice&, const Obstacles&, const Velocity<double>&, double, Quantity,
                     const Field<double>&, Field<double>&, Field<double>&);
template double interpolate(const Field<float>&, const Lattice&, const Vec3&);
template double interpolate(const Field<double>&, const Lattice&, const Vec3&);

}  // namespace airlight::stable_fluids
