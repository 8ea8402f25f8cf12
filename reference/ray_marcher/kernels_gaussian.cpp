#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/ray_marcher/kernels_gaussian.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "reference/ray_marcher/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::ray_marcher {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using VF = hn::Vec<F>;
using Mask = hn::Mask<F>;

HWY_INLINE VF squared(VF x, VF y, VF z) { return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))); }

// Sphere around up to Lanes points, and its indices of Gaussians that reach within `slack` of it or of the segment that
// starts there.
struct Neighbourhood {
  float x, y, z, radius;
};
HWY_INLINE Neighbourhood around(Mask used, VF x, VF y, VF z) {
  const F f;
  const VF big = hn::Set(f, 1e30f), small = hn::Set(f, -1e30f);
  const auto middle = [&](VF v) HWY_ATTR {
    return 0.5f * (hn::GetLane(hn::MinOfLanes(f, hn::IfThenElse(used, v, big))) +
                   hn::GetLane(hn::MaxOfLanes(f, hn::IfThenElse(used, v, small))));
  };
  Neighbourhood s{middle(x), middle(y), middle(z), 0};
  const VF d2 = squared(hn::Sub(x, hn::Set(f, s.x)), hn::Sub(y, hn::Set(f, s.y)), hn::Sub(z, hn::Set(f, s.z)));
  s.radius = std::sqrt(hn::GetLane(hn::MaxOfLanes(f, hn::IfThenElseZero(used, d2)))) * 1.0001f;
  return s;
}

long long GaussianDensity(const GaussianField& field, std::size_t n, const float* px, const float* py, const float* pz,
                          float* density) {
  const F f;
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const Mask used = hn::FirstN(f, n - i);
    const VF x = hn::LoadU(f, px + i), y = hn::LoadU(f, py + i), z = hn::LoadU(f, pz + i);
    const Neighbourhood s = around(used, x, y, z);
    VF sum = hn::Zero(f);
    for (std::size_t g = 0; g < field.count; ++g) {
      const float gx = field.x[g] - s.x, gy = field.y[g] - s.y, gz = field.z[g] - s.z;
      const float apart = field.reach[g] + s.radius;
      if (gx * gx + gy * gy + gz * gz > apart * apart) continue;
      const VF scale = hn::Set(f, field.inverse_width[g]);
      const VF d2 = squared(hn::Mul(scale, hn::Sub(x, hn::Set(f, field.x[g]))),
                            hn::Mul(scale, hn::Sub(y, hn::Set(f, field.y[g]))),
                            hn::Mul(scale, hn::Sub(z, hn::Set(f, field.z[g]))));
      const VF reach = hn::Set(f, field.reach[g] * field.inverse_width[g]);
      const VF value = hn::Mul(hn::Set(f, field.amplitude[g]), hn::Exp(f, hn::Neg(d2)));
      sum = hn::Add(sum, hn::IfThenElseZero(hn::Le(d2, hn::Mul(reach, reach)), value));
    }
    if (field.any_negative) sum = hn::Max(sum, hn::Set(f, -field.constant));
    hn::StoreU(sum, f, density + i);
  }
  return static_cast<long long>(n);
}

// Lanes are rays. All rays of a group lie within the group's radius of the segment from its middle to its light, since
// they are parallel or converge: that decides which Gaussians matter to them.
long long GaussianColumns(const GaussianField& field, const StepRule& rule, std::size_t n, const LocalRays& rays,
                          float* column) {
  const F f;
  const VF zero = hn::Zero(f), half = hn::Set(f, 0.5f), one = hn::Set(f, 1.0f);
  long long evaluations = 0;
  std::vector<float> sums;
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VF t0 = hn::LoadU(f, rays.t0 + i), t1 = hn::LoadU(f, rays.t1 + i);
    const Mask used = hn::And(hn::FirstN(f, n - i), hn::Lt(t0, t1));
    if (hn::AllFalse(f, used)) continue;
    const VF length = hn::IfThenElseZero(used, hn::Sub(t1, t0));
    VF steps = hn::Set(f, float(rule.count));
    if (rule.length > 0)
      steps = hn::Min(hn::Max(one, hn::Ceil(hn::Div(length, hn::Set(f, rule.length)))), hn::Set(f, 1048576.0f));
    const VF h = hn::Div(length, steps);
    steps = hn::IfThenElseZero(used, steps);
    const VF dx = hn::LoadU(f, rays.dx + i), dy = hn::LoadU(f, rays.dy + i), dz = hn::LoadU(f, rays.dz + i);
    const VF ox = hn::LoadU(f, rays.ox + i), oy = hn::LoadU(f, rays.oy + i), oz = hn::LoadU(f, rays.oz + i);
    // The ranges' ends bound all rays: each is in the hull of the two groups of ends.
    const auto end = [&](VF o, VF d, VF t) HWY_ATTR { return hn::MulAdd(t, d, o); };
    const Neighbourhood a = around(used, end(ox, dx, t0), end(oy, dy, t0), end(oz, dz, t0));
    const Neighbourhood b = around(used, end(ox, dx, t1), end(oy, dy, t1), end(oz, dz, t1));
    const float sx = b.x - a.x, sy = b.y - a.y, sz = b.z - a.z;
    const float radius = std::max(a.radius, b.radius), span = std::max(sx * sx + sy * sy + sz * sz, 1e-30f);
    const int most = int(hn::GetLane(hn::MaxOfLanes(f, steps)));
    sums.assign(field.any_negative ? most * hn::Lanes(f) : 0, 0.0f);
    VF total = zero;
    for (std::size_t g = 0; g < field.count; ++g) {
      const float gx = field.x[g] - a.x, gy = field.y[g] - a.y, gz = field.z[g] - a.z;
      const float s = std::clamp((gx * sx + gy * sy + gz * sz) / span, 0.0f, 1.0f);
      const float ex = gx - s * sx, ey = gy - s * sy, ez = gz - s * sz, apart = field.reach[g] + radius;
      if (ex * ex + ey * ey + ez * ez > apart * apart * 1.0001f) continue;
      // Along each ray the Gaussian is exp(-(near^2 + ((t - middle) rate)^2)).
      const VF scale = hn::Set(f, field.inverse_width[g]);
      const VF qx = hn::Mul(scale, hn::Sub(hn::Set(f, field.x[g]), ox)),
               qy = hn::Mul(scale, hn::Sub(hn::Set(f, field.y[g]), oy)),
               qz = hn::Mul(scale, hn::Sub(hn::Set(f, field.z[g]), oz));
      const VF wx = hn::Mul(scale, dx), wy = hn::Mul(scale, dy), wz = hn::Mul(scale, dz);
      const VF rate2 = squared(wx, wy, wz);
      const VF middle = hn::Div(hn::MulAdd(qx, wx, hn::MulAdd(qy, wy, hn::Mul(qz, wz))), rate2);
      const VF near2 =
          squared(hn::NegMulAdd(middle, wx, qx), hn::NegMulAdd(middle, wy, qy), hn::NegMulAdd(middle, wz, qz));
      const float reach = field.reach[g] * field.inverse_width[g];
      const VF limit = hn::Set(f, reach * reach), rate = hn::Sqrt(rate2);
      // Steps within reach, of any ray of the group.
      const VF spread = hn::Div(hn::Sqrt(hn::Max(zero, hn::Sub(limit, near2))), rate);
      const Mask met = hn::And(used, hn::Le(near2, limit));
      if (hn::AllFalse(f, met)) continue;
      const VF first = hn::Div(hn::Sub(hn::Sub(middle, spread), t0), h);
      const VF last = hn::Div(hn::Sub(hn::Add(middle, spread), t0), h);
      const int from = std::max(
          0, int(std::max(-1.0f, hn::GetLane(hn::MinOfLanes(f, hn::IfThenElse(met, first, hn::Set(f, 1e9f)))))) - 1);
      const int to = std::min(
          most, int(std::min(1e9f, hn::GetLane(hn::MaxOfLanes(f, hn::IfThenElse(met, last, hn::Set(f, -2.0f)))))) + 2);
      const VF peak = hn::Set(f, field.amplitude[g]);
      const VF u0 = hn::Mul(rate, hn::Sub(hn::MulAdd(half, h, t0), middle)), du = hn::Mul(rate, h);
      for (int j = from; j < to; ++j) {
        const VF step = hn::Set(f, float(j)), u = hn::MulAdd(step, du, u0), d2 = hn::MulAdd(u, u, near2);
        const VF value =
            hn::IfThenElseZero(hn::And(hn::Le(d2, limit), hn::Lt(step, steps)), hn::Mul(peak, hn::Exp(f, hn::Neg(d2))));
        if (field.any_negative) {
          float* at = sums.data() + j * hn::Lanes(f);
          hn::StoreU(hn::Add(hn::LoadU(f, at), value), f, at);
        } else {
          total = hn::Add(total, value);
        }
      }
    }
    // The clamp at zero density acts on the sum of all Gaussians at each step.
    for (int j = 0; field.any_negative && j < most; ++j)
      total = hn::Add(total, hn::IfThenElseZero(
                                 hn::Lt(hn::Set(f, float(j)), steps),
                                 hn::Max(hn::LoadU(f, sums.data() + j * hn::Lanes(f)), hn::Set(f, -field.constant))));
    evaluations += static_cast<long long>(hn::GetLane(hn::SumOfLanes(f, steps)));
    hn::StoreU(hn::MulAdd(total, h, hn::LoadU(f, column + i)), f, column + i);
  }
  return evaluations;
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight::ray_marcher
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::ray_marcher {

HWY_EXPORT(GaussianDensity);
long long gaussian_density(const GaussianField& field, std::size_t n, const float* x, const float* y, const float* z,
                           float* density) {
  return HWY_DYNAMIC_DISPATCH(GaussianDensity)(field, n, x, y, z, density);
}

HWY_EXPORT(GaussianColumns);
long long gaussian_columns(const GaussianField& field, const StepRule& rule, std::size_t n, const LocalRays& rays,
                           float* column) {
  return HWY_DYNAMIC_DISPATCH(GaussianColumns)(field, rule, n, rays, column);
}

}  // namespace airlight::ray_marcher
#endif
