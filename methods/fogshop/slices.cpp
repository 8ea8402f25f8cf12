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

void Slices(const double* t, const double* view_depth, const double* light_depth, const double* const* scattering,
            int slices, double along, double h, const double* hue, int channels, double* sums) {
  const V zero = hn::Zero(d);
  V sum[3] = {zero, zero, zero};
  for (int k = 0; k < slices; k += int(hn::Lanes(d))) {
    const V t0 = hn::LoadU(d, t + k), t1 = hn::LoadU(d, t + k + 1);
    const V length = hn::Sub(t1, t0), xa = hn::Sub(t0, set(along)), xb = hn::Sub(t1, set(along));
    // Integral of dt / (x^2 + h^2) over the slice, from the angle between its ends, which does not cancel.
    const V angle = angle_of(hn::Mul(set(h), length), hn::MulAdd(xa, xb, set(h * h)));
    const V valid_length = hn::Max(length, set(1e-300));
    const V mean_inverse_square = hn::Div(angle, hn::Mul(set(h), valid_length));
    const V a0 = hn::LoadU(d, view_depth + k), a1 = hn::LoadU(d, view_depth + k + 1);
    const V b0 = hn::LoadU(d, light_depth + k), b1 = hn::LoadU(d, light_depth + k + 1);
    const V step = hn::Max(hn::Sub(a1, a0), zero);
    const V s0 = hn::Add(a0, b0), s1 = hn::Add(a1, b1);
    const auto used = hn::And(hn::FirstN(d, std::size_t(slices - k)), hn::Gt(length, zero));
    for (int c = 0; c < channels; ++c) {
      const V e0 = exp_of(hn::Mul(set(-hue[c]), s0));
      const V e1 = exp_of(hn::Mul(set(-hue[c]), s1));
      // Mean of e^-s where s goes from s0 to s1 linearly: the depth from the light may fall as that from the view
      // grows.
      const V q = hn::Mul(set(hue[c]), hn::Sub(s1, s0));
      const auto small = hn::Lt(hn::Abs(q), set(1e-3));
      const V series = hn::MulAdd(q, hn::MulAdd(q, hn::MulAdd(q, set(-1.0 / 24), set(1.0 / 6)), set(-0.5)), set(1));
      const V mean =
          hn::IfThenElse(small, hn::Mul(e0, series), hn::Div(hn::Sub(e0, e1), hn::IfThenElse(small, set(1), q)));
      V scattered = step;
      if (scattering)
        scattered = hn::Max(hn::Sub(hn::LoadU(d, scattering[c] + k + 1), hn::LoadU(d, scattering[c] + k)), zero);
      const V slice = hn::Mul(hn::Mul(mean_inverse_square, hn::Mul(set(hue[c]), scattered)), mean);
      sum[c] = hn::Add(sum[c], hn::IfThenElseZero(used, slice));
    }
  }
  for (int c = 0; c < channels; ++c) sums[c] += hn::GetLane(hn::SumOfLanes(d, sum[c])) / (4 * pi);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(Slices);

namespace {

constexpr double least_h = 1e-9;  // [m]

}  // namespace

void every_other(const std::vector<double>& all, int slices, std::vector<double>& half) {
  half.assign(std::size_t(slices) / 2 + 1 + GaussianArrays::padding, all[slices]);
  for (int k = 0; k <= slices / 2; ++k) half[k] = all[2 * k];
}

void add_slices(const double* t, const double* view_depth, const double* light_depth, const double* const* scattering,
                int slices, const LightFromRay& light, double source_radius, const Rgb& hue, bool coloured,
                Rgb& airlight) {
  const double h = std::max(std::hypot(light.h, source_radius), least_h);
  HWY_DYNAMIC_DISPATCH(Slices)
  (t, view_depth, light_depth, scattering, slices, light.along, h, hue.data(), coloured ? 3 : 1, airlight.data());
}

}  // namespace airlight::fogshop
#endif
