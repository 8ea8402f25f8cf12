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

HWY_INLINE VF squared(VF x, VF y, VF z) { return MulAdd(x, x, MulAdd(y, y, z * z)); }

// Sphere around up to Lanes points.
struct Neighbourhood {
  float x, y, z, radius;
};
HWY_INLINE Neighbourhood around(Mask used, VF x, VF y, VF z) {
  const F f;
  const VF big = hn::Set(f, 1e30f), small = hn::Set(f, -1e30f);
  const auto middle = [&](VF v) HWY_ATTR {
    return 0.5f * (hn::GetLane(hn::MinOfLanes(f, IfThenElse(used, v, big))) +
                   hn::GetLane(hn::MaxOfLanes(f, IfThenElse(used, v, small))));
  };
  Neighbourhood s{middle(x), middle(y), middle(z), 0};
  const VF d2 = squared(x - hn::Set(f, s.x), y - hn::Set(f, s.y), z - hn::Set(f, s.z));
  s.radius = std::sqrt(hn::GetLane(hn::MaxOfLanes(f, IfThenElseZero(used, d2)))) * 1.0001f;
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
      const VF d2 = squared(scale * (x - hn::Set(f, field.x[g])), scale * (y - hn::Set(f, field.y[g])),
                            scale * (z - hn::Set(f, field.z[g])));
      const VF reach = hn::Set(f, field.reach[g] * field.inverse_width[g]);
      const VF value = hn::Set(f, field.amplitude[g]) * hn::Exp(f, Neg(d2));
      sum = sum + IfThenElseZero(d2 <= reach * reach, value);
    }
    if (field.any_negative) sum = Max(sum, hn::Set(f, -field.constant));
    hn::StoreU(sum, f, density + i);
  }
  return static_cast<long long>(n);
}

// Up to Lanes rays, one per lane, with what encloses them.
struct RayGroup {
  Mask used;
  VF t0, t1, ox, oy, oz, dx, dy, dz;
  Neighbourhood a;         // around the beginnings
  float sx, sy, sz, span;  // from there to around the ends; its squared length
  float radius;

  RayGroup(std::size_t i, std::size_t n, const LocalRays& rays) {
    const F f;
    t0 = hn::LoadU(f, rays.t0 + i), t1 = hn::LoadU(f, rays.t1 + i);
    dx = hn::LoadU(f, rays.dx + i), dy = hn::LoadU(f, rays.dy + i), dz = hn::LoadU(f, rays.dz + i);
    ox = hn::LoadU(f, rays.ox + i), oy = hn::LoadU(f, rays.oy + i), oz = hn::LoadU(f, rays.oz + i);
    used = And(hn::FirstN(f, n - i), t0 < t1);
    const auto at = [&](VF t)
                        HWY_ATTR { return around(used, MulAdd(t, dx, ox), MulAdd(t, dy, oy), MulAdd(t, dz, oz)); };
    a = at(t0);
    const Neighbourhood b = at(t1);
    sx = b.x - a.x, sy = b.y - a.y, sz = b.z - a.z;
    span = std::max(sx * sx + sy * sy + sz * sz, 1e-30f);
    radius = std::max(a.radius, b.radius);
  }

  // Each ray is in the hull of the spheres around both groups of ends: a Gaussian out of reach of it matters to none.
  bool misses(const GaussianField& field, std::size_t g) const {
    const float gx = field.x[g] - a.x, gy = field.y[g] - a.y, gz = field.z[g] - a.z;
    const float s = std::clamp((gx * sx + gy * sy + gz * sz) / span, 0.0f, 1.0f);
    const float ex = gx - s * sx, ey = gy - s * sy, ez = gz - s * sz, apart = field.reach[g] + radius;
    return ex * ex + ey * ey + ez * ez > apart * apart * 1.0001f;
  }
};

// A Gaussian along each ray: amplitude * exp(-(near^2 + ((t - middle) * rate)^2)), for |t - middle| <= spread.
struct Profile {
  VF middle, rate, near2, limit, spread;
  Mask met;

  Profile(const GaussianField& field, std::size_t g, const RayGroup& rays) {
    const F f;
    const VF scale = hn::Set(f, field.inverse_width[g]);
    const VF qx = scale * (hn::Set(f, field.x[g]) - rays.ox), qy = scale * (hn::Set(f, field.y[g]) - rays.oy),
             qz = scale * (hn::Set(f, field.z[g]) - rays.oz);
    const VF wx = scale * rays.dx, wy = scale * rays.dy, wz = scale * rays.dz;
    const VF rate2 = squared(wx, wy, wz);
    rate = Sqrt(rate2);
    middle = MulAdd(qx, wx, MulAdd(qy, wy, qz * wz)) / rate2;
    near2 = squared(NegMulAdd(middle, wx, qx), NegMulAdd(middle, wy, qy), NegMulAdd(middle, wz, qz));
    const float reach = field.reach[g] * field.inverse_width[g];
    limit = hn::Set(f, reach * reach);
    spread = Sqrt(Max(hn::Zero(f), limit - near2)) / rate;
    met = And(rays.used, near2 <= limit);
  }
};

long long GaussianColumns(const GaussianField& field, const StepRule& rule, std::size_t n, const LocalRays& rays,
                          float* column) {
  const F f;
  const VF zero = hn::Zero(f), half = hn::Set(f, 0.5f), one = hn::Set(f, 1.0f);
  long long evaluations = 0;
  std::vector<float> sums;
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const RayGroup group(i, n, rays);
    if (hn::AllFalse(f, group.used)) continue;
    const VF length = IfThenElseZero(group.used, group.t1 - group.t0);
    VF steps = hn::Set(f, float(rule.count));
    if (rule.length > 0) steps = Min(Max(one, hn::Ceil(length / hn::Set(f, rule.length))), hn::Set(f, 1048576.0f));
    const VF h = length / steps;
    steps = IfThenElseZero(group.used, steps);
    const int most = int(hn::GetLane(hn::MaxOfLanes(f, steps)));
    sums.assign(field.any_negative ? most * hn::Lanes(f) : 0, 0.0f);
    VF total = zero;
    for (std::size_t g = 0; g < field.count; ++g) {
      if (group.misses(field, g)) continue;
      const Profile p(field, g, group);
      if (hn::AllFalse(f, p.met)) continue;
      // Steps within reach, of any ray of the group.
      const VF first = (p.middle - p.spread - group.t0) / h;
      const VF last = (p.middle + p.spread - group.t0) / h;
      const float least = hn::GetLane(hn::MinOfLanes(f, IfThenElse(p.met, first, hn::Set(f, 1e9f))));
      const float greatest = hn::GetLane(hn::MaxOfLanes(f, IfThenElse(p.met, last, hn::Set(f, -2.0f))));
      const int from = int(std::clamp(least - 1, 0.0f, 1e9f)), to = std::min(most, int(std::min(greatest, 1e9f)) + 2);
      const VF peak = hn::Set(f, field.amplitude[g]);
      const VF u0 = p.rate * (MulAdd(half, h, group.t0) - p.middle), du = p.rate * h;
      for (int j = from; j < to; ++j) {
        const VF step = hn::Set(f, float(j)), u = MulAdd(step, du, u0), d2 = MulAdd(u, u, p.near2);
        const VF value = IfThenElseZero(And(d2 <= p.limit, step < steps), peak * hn::Exp(f, Neg(d2)));
        if (field.any_negative) {
          float* at = sums.data() + j * hn::Lanes(f);
          hn::StoreU(hn::LoadU(f, at) + value, f, at);
        } else {
          total = total + value;
        }
      }
    }
    // The clamp at zero density acts on the sum of all Gaussians at each step.
    for (int j = 0; field.any_negative && j < most; ++j)
      total = total + IfThenElseZero(hn::Set(f, float(j)) < steps,
                                     Max(hn::LoadU(f, sums.data() + j * hn::Lanes(f)), hn::Set(f, -field.constant)));
    evaluations += static_cast<long long>(hn::GetLane(hn::SumOfLanes(f, steps)));
    hn::StoreU(MulAdd(total, h, hn::LoadU(f, column + i)), f, column + i);
  }
  return evaluations;
}

// erf, absolute error 1.5e-7: Abramowitz and Stegun, formula 7.1.26. Absolute is what counts, in optical depths.
HWY_INLINE VF error_function(VF x) {
  const F f;
  const VF size = Abs(x);
  const VF t = hn::Set(f, 1.0f) / MulAdd(hn::Set(f, 0.3275911f), size, hn::Set(f, 1.0f));
  VF sum = MulAdd(hn::Set(f, 1.061405429f), t, hn::Set(f, -1.453152027f));
  sum = MulAdd(sum, t, hn::Set(f, 1.421413741f));
  sum = MulAdd(sum, t, hn::Set(f, -0.284496736f));
  sum = MulAdd(sum, t, hn::Set(f, 0.254829592f));
  const VF tail = sum * t * hn::Exp(f, Neg(size * size));
  return hn::CopySign(hn::Set(f, 1.0f) - tail, x);
}

// Zhou et al. 2007, Eq. 31: sqrt(pi)/2 * amplitude * exp(-near^2) / rate * (erf(u1) - erf(u0)).
void GaussianIntegrals(const GaussianField& field, std::size_t n, const LocalRays& rays, float* column) {
  const F f;
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const RayGroup group(i, n, rays);
    if (hn::AllFalse(f, group.used)) continue;
    VF total = hn::Zero(f);
    for (std::size_t g = 0; g < field.count; ++g) {
      if (group.misses(field, g)) continue;
      const Profile p(field, g, group);
      if (hn::AllFalse(f, p.met)) continue;
      // Where it is cut off, or as good as zero, is outside.
      const VF reach = p.rate * p.spread;
      const auto edge = [&](VF t) HWY_ATTR { return Min(reach, Max(Neg(reach), p.rate * (t - p.middle))); };
      const VF between = error_function(edge(group.t1)) - error_function(edge(group.t0));
      const VF height = hn::Set(f, 0.886226925f * field.amplitude[g]) * hn::Exp(f, Neg(p.near2)) / p.rate;
      total = total + IfThenElseZero(p.met, height * between);
    }
    hn::StoreU(total + hn::LoadU(f, column + i), f, column + i);
  }
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

HWY_EXPORT(GaussianIntegrals);
void gaussian_integrals(const GaussianField& field, std::size_t n, const LocalRays& rays, float* column) {
  HWY_DYNAMIC_DISPATCH(GaussianIntegrals)(field, n, rays, column);
}

}  // namespace airlight::ray_marcher
#endif
