#include "methods/fogshop/bare_loop.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/bare_loop.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "methods/fogshop/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

// Sums body(x) over values of x that are near 0.3 and never the same. Four at a time, so that no evaluation waits for
// the one before.
template <class Body>
double repeat(long count, double seed, const Body& body) {
  V x = hn::MulAdd(hn::Iota(d, seed), set(1e-3), set(0.3)),
    sum[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const long vectors = (count + long(hn::Lanes(d)) - 1) / long(hn::Lanes(d));
  for (long i = 0; i < vectors; i += 4)
    for (V& s : sum) {
      s = hn::Add(s, body(x));
      x = hn::Add(x, set(1e-9));
    }
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(sum[0], sum[1]), hn::Add(sum[2], sum[3]))));
}

template <Erf kind>
double BareLoopOf(BareLoop what, long count, double seed) {
  const V middle = set(3), depth = set(0.1), base = set(0.5), t = hn::Iota(d, 1.0), half = set(0.5);
  const Vectors direction{set(0.48), set(0.36), set(0.8)};
  switch (what) {
    case BareLoop::error_function:
      return repeat(count, seed, [&](V x) { return Erf_<kind>(d, x); });
    case BareLoop::crossing:
      return repeat(count, seed, [&](V x) {
        const Projection p = project({hn::Sub(x, half), hn::Sub(x, middle), hn::Sub(base, x)}, direction);
        return hn::MulAdd(depth, exp_of(peak_exponent(x, p.squared)), Erf_<kind>(d, hn::Mul(x, p.middle)));
      });
    case BareLoop::depth:
      return repeat(count, seed, [&](V x) { return hn::Mul(depth, share_up_to<kind>(t, x, middle, base)); });
    default:
      return repeat(count, seed, [&](V x) {
        const Vectors nearest{hn::MulAdd(x, direction.x, half), hn::MulAdd(x, direction.y, half),
                              hn::MulAdd(x, direction.z, middle)};
        const PaperTerm term = paper_term<kind>({hn::Sub(x, half), hn::Sub(x, middle), hn::Sub(base, x)}, nearest, x,
                                                depth, base, depth, half, base);
        return hn::Mul(term.weight, exp_of(term.exponent));
      });
  }
}

double BareLoopAny(BareLoop what, Erf erf, long count, double seed) {
  if (erf == Erf::precise) return BareLoopOf<Erf::precise>(what, count, seed);
  if (erf == Erf::erf10) return BareLoopOf<Erf::erf10>(what, count, seed);
  return BareLoopOf<Erf::paper>(what, count, seed);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(BareLoopAny);

double bare_loop(BareLoop what, Erf erf, long count, double seed) {
  return HWY_DYNAMIC_DISPATCH(BareLoopAny)(what, erf, count, seed);
}

}  // namespace airlight::fogshop
#endif
