// What is counted: each sweep over the fields reads every array that it needs once and writes its results once, as if
// nothing were left in a cache from the sweep before, and as if what it reads around a foot came with the rest. What a
// store reads first (write-allocation) is not counted, here and in the streaming kernel alike.
#include <cmath>

#include "experiments/application/interrupt.h"
#include "experiments/stable_fluids/probes.h"
#include "experiments/stable_fluids/stages.h"
#include "reference/stable_fluids/advection.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

using namespace stable_fluids;

// a = b + s c, over arrays beyond any cache: STREAM's triad (McCalpin 1995), with all threads.
class Triad {
 public:
  Triad() : a_(count, 0.0), b_(count, 1.0), c_(count, 2.0) {}
  double bytes_per_second() {
    scene::Stopwatch watch;
    for_each(chunks, [&](int chunk) {
      constexpr std::size_t each = count / chunks;
      double* a = a_.data() + chunk * each;
      const double *b = b_.data() + chunk * each, *c = c_.data() + chunk * each;
      for (std::size_t i = 0; i < each; ++i) a[i] = b[i] + 0.5 * c[i];
    });
    const double seconds = watch.lap();
    if (a_.front() != 2 || a_.back() != 2) throw Error("the streaming kernel was left out");  // by the compiler
    return 3.0 * sizeof(double) * count / seconds;
  }

 private:
  static constexpr std::size_t count = std::size_t(1) << 23;  // 64 MiB each
  static constexpr int chunks = 64;
  std::vector<double> a_, b_, c_;
};

// Values that a pass over one field moves for each of its samples. A component of the velocity is one of the three
// fields that carry it.
int values_moved(const Advection& how, bool component) {
  const int from = component ? 0 : 1, limits = how.limiter == Limiter::none ? 0 : 2;
  const int carry = 3 + from + 1;
  if (how.scheme == Scheme::semi_lagrangian) return carry;
  const int carry_in_range = carry + 2;
  if (how.scheme == Scheme::maccormack) return carry_in_range + 3 + 1 + from + limits + 1;
  const int compensate = 3 + 1 + from + 1, carry_again = 3 + 1 + 1, limit = 2 + limits + 1;
  return carry_in_range + compensate + carry_again + limit;
}

// Eddies of half the box, 1 m/s at most along each axis.
template <class Real>
Velocity<Real> eddies(const Lattice& l) {
  Velocity<Real> u;
  for (int a = 0; a < 3; ++a) {
    u[a] = Field<Real>(l, a);
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    for_rows(u[a].n, [&](int j, int k) {
      for (int i = 0; i < u[a].n[0]; ++i) {
        const Point3 x = u[a].position(l, i, j, k);
        u[a].at(i, j, k) = Real(std::sin(2 * pi * x[a]) * std::cos(2 * pi * x[b]) * std::cos(2 * pi * x[c]));
      }
    });
    fill_ghosts(u[a], Quantity::velocity, l);
  }
  return u;
}

template <class Real>
Findings measure_advection(const scene::Settings& s) {
  const Advection how{s.choice<Scheme>("scheme"), s.choice<Interpolation>("interpolation"),
                      s.choice<Limiter>("limiter"), int(s.integer("trace"))};
  const bool component = s.text("of") == "velocity";
  const Lattice l = make_lattice(unit_cube(scene::Side::Kind::free_slip), int(s.integer("n")));
  const Obstacles none;
  const double dt = s.real("cfl") * l.h;
  const Velocity<Real> u = eddies<Real>(l);
  std::vector<Field<Real>> from;
  if (component)
    from.assign(u.begin(), u.end());
  else
    from.push_back(noise_field<Real>(l, at_centers));
  const Quantity quantity = component ? Quantity::velocity : Quantity::density;
  for (Field<Real>& f : from) fill_ghosts(f, quantity, l, component ? Walls::as_they_are : Walls::carried);
  std::vector<Field<Real>> to = from;
  Workspace<Real> work;
  const double cells = double(count_of(l.n)), values = values_moved(how, component) * double(from.size());
  Triad triad;
  std::vector<double> seconds, rates, memory, share;
  const auto pass = [&] {
    // A component is carried from the velocity's own fields, as in a step.
    for (std::size_t i = 0; i < from.size(); ++i)
      advect(how, l, none, u, dt, quantity, component ? u[i] : from[i], to[i], work);
  };
  pass();
  triad.bytes_per_second();
  repeat(int(s.integer("runs")), s.real("budget"), [&] {
    check_interrupted();
    scene::Stopwatch watch;
    pass();
    seconds.push_back(watch.lap());
    memory.push_back(triad.bytes_per_second() / 1e9);
    rates.push_back(values * sizeof(Real) * cells / seconds.back() / 1e9);
    share.push_back(rates.back() / memory.back());
  });
  std::vector<double> each = seconds;
  for (double& t : each) t *= 1e9 / cells;
  Findings found;
  found.figures = {measured("ns_per_cell", each), exactly("bytes_per_cell", values * sizeof(Real)),
                   measured("rate", rates), measured("memory_rate", memory), measured("share", share)};
  return found;
}

}  // namespace

std::string AdvectionRate::about() const {
  return "advection of a velocity or a scalar: time, bytes that it must move, and the memory's bandwidth";
}

std::vector<scene::SettingSpec> AdvectionRate::settings() const {
  return {scene::choice_setting("scheme", "maccormack", {"semi_lagrangian", "maccormack", "bfecc"}, "of advection"),
          scene::choice_setting("interpolation", "linear", {"linear", "cubic"}, "between samples"),
          scene::choice_setting("limiter", "clamp", {"none", "clamp", "revert"}, "of corrections"),
          scene::integer_setting("trace", "2", 1, 4, "order of the method that finds the foot: 1, 2, 4"),
          scene::choice_setting("of", "velocity", {"velocity", "scalar"}, "all three components, or one field"),
          scene::integer_setting("n", "64", 2, 1024, "cells a side of a cube"),
          scene::real_setting("cfl", "1", 0, 100, "greatest way a step [cells]"),
          scene::choice_setting("precision", "float", {"float", "double"}, "of all fields"),
          scene::integer_setting("runs", "15", 1, 10000, "timed, each beside the streaming kernel"),
          scene::real_setting("budget", "1", 0, 1e6, "seconds after which no further run begins")};
}

std::vector<std::string> AdvectionRate::figures() const {
  return {"ns_per_cell", "bytes_per_cell", "rate", "memory_rate", "share"};
}

Findings AdvectionRate::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  if (s.integer("trace") == 3) throw Error("trace = 3: expected 1, 2 or 4");
  Findings found;
  with_threads(execution, [&] {
    found = s.text("precision") == "double" ? measure_advection<double>(s) : measure_advection<float>(s);
  });
  return found;
}

}  // namespace airlight::experiments
