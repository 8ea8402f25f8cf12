#include "methods/fogshop/slices.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/slices.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "methods/fogshop/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

// Angle of (x, y) for y >= 0, in [0, pi].
HWY_INLINE V angle_of(V y, V x) {
  const V zero = hn::Zero(d);
  const V slope = y / IfThenElse(x == zero, set(1e-300), x);
  const V angle = hn::Atan(d, Min(Max(slope, set(-1e300)), set(1e300)));
  return IfThenElse(x < zero, angle + set(pi), angle);
}

struct Direction {
  V x, h;
};
HWY_INLINE Direction normalized(V x, V h) {
  const V inverse = set(1) / Max(Sqrt(MulAdd(x, x, h * h)), set(1e-300));
  return {x * inverse, h * inverse};
}
HWY_INLINE Direction halfway(const Direction& a, const Direction& b) { return normalized(a.x + b.x, a.h + b.h); }

// Mean of the phase function, times 4 pi, over the angle between two places beside a light that passes at h: Boole's rule.
HWY_INLINE V mean_phase(double g, V xa, V xb, double h) {
  const Direction a = normalized(xa, set(h)), b = normalized(xb, set(h)), middle = halfway(a, b);
  const V ends = phase_of(g, a.x) + phase_of(g, b.x);
  const V quarters = phase_of(g, halfway(a, middle).x) + phase_of(g, halfway(middle, b).x);
  return MulAdd(set(7. / 90), ends, MulAdd(set(32. / 90), quarters, set(12. / 90) * phase_of(g, middle.x)));
}

// Precomputes shared values of slices and pairs: integrals of h dt / (x^2 + h^2) over the slices, times the phase
// function; depths and transmittances of the whole path from the light over an edge to the viewer, at every edge. h:
// distance of the light from the ray, softened by the source's radius for 1/d^2; beside: the unsoftened distance, for
// the phase function's angle.
void Prepare(const SliceEdges& e, int slices, double along, double h, double beside, double g,
             const double* extinction_ratio, int channels, SliceScratch& out) {
  for (int k = 0; k < slices; k += int(hn::Lanes(d))) {
    const V t0 = hn::LoadU(d, e.t + k), t1 = hn::LoadU(d, e.t + k + 1);
    const V xa = t0 - set(along), xb = t1 - set(along);
    // From the angle between the ends, which does not cancel.
    const V angle = angle_of(set(h) * (t1 - t0), MulAdd(xa, xb, set(h * h)));
    hn::StoreU(g == 0 ? angle : angle * mean_phase(g, xa, xb, beside), d, out.weighted_angle.data() + k);
  }
  for (int k = 0; k <= slices; k += int(hn::Lanes(d))) {
    const V whole = hn::LoadU(d, e.view_depth + k) + hn::LoadU(d, e.light_depth + k);
    hn::StoreU(whole, d, out.depth.data() + k);
    for (int c = 0; c < channels; ++c)
      hn::StoreU(exp_of(set(-extinction_ratio[c]) * whole), d, out.transmittance[c].data() + k);
  }
}

// Values at both ends of slices k, k + 1, ... of `stride` of the given ones.
struct Ends {
  V near, far;
};
template <int stride>
HWY_INLINE Ends ends(const double* values, int k) {
  if constexpr (stride == 1) return {hn::LoadU(d, values + k), hn::LoadU(d, values + k + 1)};
  V near, far, between;
  hn::LoadInterleaved2(d, values + 2 * k, near, between);
  hn::LoadInterleaved2(d, values + 2 * k + 2, far, between);
  return {near, far};
}

// A slice's airlight is what it scatters, times the mean of e^-depth, times the mean of 1/d^2:
//   mean of e^-depth = (e^-depth0 - e^-depth1) / (depth1 - depth0), mean of 1/d^2 = angle / (h length).
// The depth of the whole way goes linearly from one edge to the other: that from the light may fall as that from the view grows.
template <int stride>
void Sum(const SliceEdges& e, const SliceScratch& scratch, int slices, double h, const double* extinction_ratio,
         int channels, double* sums) {
  const V zero = hn::Zero(d), one = set(1);
  V sum[3] = {zero, zero, zero};
  for (int k = 0; k < slices; k += int(hn::Lanes(d))) {
    const auto [t0, t1] = ends<stride>(e.t, k);
    const auto [view0, view1] = ends<stride>(e.view_depth, k);
    const auto [depth0, depth1] = ends<stride>(scratch.depth.data(), k);
    V angle = hn::LoadU(d, scratch.weighted_angle.data() + k);
    if constexpr (stride == 2) {
      V second;
      hn::LoadInterleaved2(d, scratch.weighted_angle.data() + 2 * k, angle, second);
      angle = angle + second;
    }
    const V length = t1 - t0;
    const auto used = And(hn::FirstN(d, std::size_t(slices - k)), length > zero);
    for (int c = 0; c < channels; ++c) {
      const auto [e0, e1] = ends<stride>(scratch.transmittance[c].data(), k);
      const V q = set(extinction_ratio[c]) * (depth1 - depth0);
      const auto small = Abs(q) < set(1e-3);
      const V series = MulAdd(q, MulAdd(q, MulAdd(q, set(-1.0 / 24), set(1.0 / 6)), set(-0.5)), one);
      const V mean = IfThenElse(small, e0 * series, e0 - e1);
      // One division by both divisors.
      const V divisor = set(h) * length * IfThenElse(small, one, q);
      V scattered = view1 - view0;
      if (e.scattering) {
        const auto [before, after] = ends<stride>(e.scattering[c], k);
        scattered = after - before;
      }
      const V slice = angle * (set(extinction_ratio[c]) * Max(scattered, zero)) * mean / divisor;
      sum[c] = sum[c] + IfThenElseZero(used, slice);
    }
  }
  for (int c = 0; c < channels; ++c) sums[c] += hn::GetLane(hn::SumOfLanes(d, sum[c])) / (4 * pi);
}

void SumSlices(const SliceEdges& e, int slices, double along, double h, double beside, double g,
               const double* extinction_ratio, int channels, SliceScratch& scratch, double* all, double* pairs) {
  Prepare(e, slices, along, h, beside, g, extinction_ratio, channels, scratch);
  Sum<1>(e, scratch, slices, h, extinction_ratio, channels, all);
  if (pairs) Sum<2>(e, scratch, slices / 2, h, extinction_ratio, channels, pairs);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(SumSlices);

void sum_slices(const SliceEdges& edges, int slices, const LightFromRay& light, double source_radius, double g,
                const Rgb& extinction_ratio, bool coloured, SliceScratch& scratch, Rgb& all, Rgb* pairs) {
  constexpr double least_h = 1e-9;  // [m]
  const double h = std::max(std::hypot(light.h, source_radius), least_h);
  const std::size_t room = slice_room(slices);
  for (auto* v : {&scratch.weighted_angle, &scratch.depth, &scratch.transmittance[0], &scratch.transmittance[1],
                  &scratch.transmittance[2]})
    v->resize(room);
  HWY_DYNAMIC_DISPATCH(SumSlices)
  (edges, slices, light.along, h, std::max(light.h, least_h), g, extinction_ratio.data(), coloured ? 3 : 1, scratch,
   all.data(), pairs ? pairs->data() : nullptr);
}

}  // namespace airlight::fogshop
#endif
