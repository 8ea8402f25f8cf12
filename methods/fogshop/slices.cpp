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
  const V slope = hn::Div(y, hn::IfThenElse(hn::Eq(x, zero), set(1e-300), x));
  const V angle = hn::Atan(d, hn::Min(hn::Max(slope, set(-1e300)), set(1e300)));
  return hn::IfThenElse(hn::Lt(x, zero), hn::Add(angle, set(pi)), angle);
}

struct Direction {
  V x, h;
};
HWY_INLINE Direction normalized(V x, V h) {
  const V inverse = hn::Div(set(1), hn::Max(hn::Sqrt(hn::MulAdd(x, x, hn::Mul(h, h))), set(1e-300)));
  return {hn::Mul(x, inverse), hn::Mul(h, inverse)};
}
HWY_INLINE Direction halfway(const Direction& a, const Direction& b) {
  return normalized(hn::Add(a.x, b.x), hn::Add(a.h, b.h));
}

// Mean of the phase function, times 4 pi, over the angle between two places beside a light that passes at h: Boole's rule.
HWY_INLINE V mean_phase(double g, V xa, V xb, double h) {
  const Direction a = normalized(xa, set(h)), b = normalized(xb, set(h)), middle = halfway(a, b);
  const V ends = hn::Add(phase_of(g, a.x), phase_of(g, b.x));
  const V quarters = hn::Add(phase_of(g, halfway(a, middle).x), phase_of(g, halfway(middle, b).x));
  return hn::MulAdd(set(7. / 90), ends,
                    hn::MulAdd(set(32. / 90), quarters, hn::Mul(set(12. / 90), phase_of(g, middle.x))));
}

// What the slices and their pairs share: integrals of h dt / (x^2 + h^2) over the slices, times the phase function, depths and transmittances of
// the whole way from the light at the edges.
void Prepare(const SliceEdges& e, int slices, double along, double h, double beside, double g,
             const double* extinction_ratio, int channels, SliceScratch& out) {
  for (int k = 0; k < slices; k += int(hn::Lanes(d))) {
    const V t0 = hn::LoadU(d, e.t + k), t1 = hn::LoadU(d, e.t + k + 1);
    const V xa = hn::Sub(t0, set(along)), xb = hn::Sub(t1, set(along));
    // From the angle between the ends, which does not cancel.
    V angle = angle_of(hn::Mul(set(h), hn::Sub(t1, t0)), hn::MulAdd(xa, xb, set(h * h)));
    if (g != 0) angle = hn::Mul(angle, mean_phase(g, xa, xb, beside));
    hn::StoreU(angle, d, out.angle.data() + k);
  }
  for (int k = 0; k <= slices; k += int(hn::Lanes(d))) {
    const V whole = hn::Add(hn::LoadU(d, e.view_depth + k), hn::LoadU(d, e.light_depth + k));
    hn::StoreU(whole, d, out.depth.data() + k);
    for (int c = 0; c < channels; ++c)
      hn::StoreU(exp_of(hn::Mul(set(-extinction_ratio[c]), whole)), d, out.transmittance[c].data() + k);
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

template <int stride>
void Sum(const SliceEdges& e, const SliceScratch& s, int slices, double h, const double* extinction_ratio, int channels,
         double* sums) {
  const V zero = hn::Zero(d), one = set(1);
  V sum[3] = {zero, zero, zero};
  for (int k = 0; k < slices; k += int(hn::Lanes(d))) {
    const auto [t0, t1] = ends<stride>(e.t, k);
    const auto [a0, a1] = ends<stride>(e.view_depth, k);
    const auto [s0, s1] = ends<stride>(s.depth.data(), k);
    V angle = hn::LoadU(d, s.angle.data() + k);
    if constexpr (stride == 2) {
      V second;
      hn::LoadInterleaved2(d, s.angle.data() + 2 * k, angle, second);
      angle = hn::Add(angle, second);
    }
    const V length = hn::Sub(t1, t0);
    const auto used = hn::And(hn::FirstN(d, std::size_t(slices - k)), hn::Gt(length, zero));
    for (int c = 0; c < channels; ++c) {
      const auto [e0, e1] = ends<stride>(s.transmittance[c].data(), k);
      // Mean of e^-s where s goes from s0 to s1 linearly: the depth from the light may fall as that from the view
      // grows. Its divisor is that of the mean of 1/d^2, too.
      const V q = hn::Mul(set(extinction_ratio[c]), hn::Sub(s1, s0));
      const auto small = hn::Lt(hn::Abs(q), set(1e-3));
      const V series = hn::MulAdd(q, hn::MulAdd(q, hn::MulAdd(q, set(-1.0 / 24), set(1.0 / 6)), set(-0.5)), one);
      const V mean = hn::IfThenElse(small, hn::Mul(e0, series), hn::Sub(e0, e1));
      const V divisor = hn::Mul(hn::Mul(set(h), length), hn::IfThenElse(small, one, q));
      V scattered = hn::Sub(a1, a0);
      if (e.scattering) {
        const auto [c0, c1] = ends<stride>(e.scattering[c], k);
        scattered = hn::Sub(c1, c0);
      }
      const V slice =
          hn::Div(hn::Mul(hn::Mul(angle, hn::Mul(set(extinction_ratio[c]), hn::Max(scattered, zero))), mean), divisor);
      sum[c] = hn::Add(sum[c], hn::IfThenElseZero(used, slice));
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
  for (auto* v : {&scratch.angle, &scratch.depth, &scratch.transmittance[0], &scratch.transmittance[1],
                  &scratch.transmittance[2]})
    v->resize(room);
  HWY_DYNAMIC_DISPATCH(SumSlices)
  (edges, slices, light.along, h, std::max(light.h, least_h), g, extinction_ratio.data(), coloured ? 3 : 1, scratch,
   all.data(), pairs ? pairs->data() : nullptr);
}

}  // namespace airlight::fogshop
#endif
