#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/ray_marcher/kernels_light.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <limits>

#include "reference/ray_marcher/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::ray_marcher {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using H = hn::Rebind<float, D>;
using F = hn::ScalableTag<float>;
using VD = hn::Vec<D>;
using VF = hn::Vec<F>;

void StepWeights(std::size_t n, const float* before, const float* depth, const float* length, float* weight) {
  const F f;
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VF x = hn::LoadU(f, depth + i);
    const auto some = x > hn::Zero(f);
    const VF mean = IfThenElse(some, Neg(hn::Expm1(f, Neg(x))) / x, hn::Set(f, 1.0f));
    hn::StoreU(hn::Exp(f, Neg(hn::LoadU(f, before + i))) * mean * hn::LoadU(f, length + i), f, weight + i);
  }
}

HWY_INLINE VD dot(VD ax, VD ay, VD az, VD bx, VD by, VD bz) { return MulAdd(ax, bx, MulAdd(ay, by, az * bz)); }

// atan2(y, x) for y > 0.
HWY_INLINE VD upper_angle(VD y, VD x) {
  const D d;
  const VD size = Abs(x), half_turn = hn::Set(d, 3.14159265358979323846);
  const auto steep = y > size;
  const VD ratio = IfThenElse(steep, x, y) / Max(y, size);
  const VD angle = hn::Atan(d, ratio);
  return IfThenElse(steep, hn::Set(d, 0.5) * half_turn - angle, IfThenElse(x < hn::Zero(d), half_turn - angle, angle));
}

void Incident(const LightShape& light, std::size_t n, const LitSteps& steps, const Incidence& out) {
  const D d;
  const H h;
  const VD one = hn::Set(d, 1.0), half = hn::Set(d, 0.5), zero = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VD rx = hn::LoadU(d, steps.dx + i), ry = hn::LoadU(d, steps.dy + i), rz = hn::LoadU(d, steps.dz + i);
    VD tx = hn::Set(d, light.axis[0]), ty = hn::Set(d, light.axis[1]), tz = hn::Set(d, light.axis[2]);
    VD distance = hn::Set(d, std::numeric_limits<double>::infinity()), strength = one;
    if (light.kind != LightShape::directional) {
      const VD x = hn::Set(d, light.position[0]) - hn::LoadU(d, steps.x + i),
               y = hn::Set(d, light.position[1]) - hn::LoadU(d, steps.y + i),
               z = hn::Set(d, light.position[2]) - hn::LoadU(d, steps.z + i);
      distance = Sqrt(Max(dot(x, y, z, x, y, z), hn::Set(d, 1e-60)));
      const VD inverse = one / distance;
      tx = x * inverse, ty = y * inverse, tz = z * inverse;
      // Mean of the inverse square over the step: the angle under which the light sees it over (h * length).
      const VD length = hn::PromoteTo(d, hn::LoadU(h, steps.length + i));
      const VD along = Neg(dot(x, y, z, rx, ry, rz));  // of the midpoint, from the foot of the light
      const VD px = MulAdd(along, rx, x), py = MulAdd(along, ry, y), pz = MulAdd(along, rz, z);
      const VD near = Max(Sqrt(dot(px, py, pz, px, py, pz)), hn::Set(d, 1e-12) * length);
      const VD a = NegMulAdd(half, length, along), b = MulAdd(half, length, along), area = near * length;
      strength = upper_angle(area, MulAdd(near, near, a * b)) / area;
      if (light.kind == LightShape::spot) {
        const VD cosine =
            Neg(dot(tx, ty, tz, hn::Set(d, light.axis[0]), hn::Set(d, light.axis[1]), hn::Set(d, light.axis[2])));
        const double width = light.cos_inner - light.cos_outer;
        const VD u =
            Min(one, Max(zero, (cosine - hn::Set(d, light.cos_outer)) / hn::Set(d, width > 0 ? width : 1e-300)));
        strength = strength * (u * u * NegMulAdd(hn::Set(d, 2.0), u, hn::Set(d, 3.0)));
      }
    }
    const auto store = [&](VD v, float* p) HWY_ATTR { hn::StoreU(hn::DemoteTo(h, v), h, p + i); };
    store(tx, out.to_x), store(ty, out.to_y), store(tz, out.to_z);
    store(distance, out.distance);
    store(strength, out.strength);
    // The cosine is dot(to light, ray). Half the squared differences keep their digits near both ends.
    const VD mx = tx - rx, my = ty - ry, mz = tz - rz;
    const VD sx = tx + rx, sy = ty + ry, sz = tz + rz;
    store(half * dot(mx, my, mz, mx, my, mz), out.minus);
    store(half * dot(sx, sy, sz, sx, sy, sz), out.plus);
  }
}

HWY_INLINE VF phase(const PhaseShape& shape, VF minus, VF plus) {
  const F f;
  const float per_sphere = 0.07957747154594767f;
  const auto eighth = [](VF v) HWY_ATTR {
    v = v * v;
    v = v * v;
    return v * v;
  };
  const VF half_plus = hn::Set(f, 0.5f) * plus;
  switch (shape.kind) {
    case PhaseShape::isotropic:
      break;
    case PhaseShape::rayleigh: {
      const VF c = hn::Set(f, 0.5f) * (plus - minus);
      return hn::Set(f, 0.75f * per_sphere) * MulAdd(c, c, hn::Set(f, 1.0f));
    }
    case PhaseShape::henyey_greenstein: {
      const float g = shape.g < 0 ? -shape.g : shape.g;
      const VF d = MulAdd(hn::Set(f, 2 * g), shape.g < 0 ? plus : minus, hn::Set(f, (1 - g) * (1 - g)));
      return hn::Set(f, per_sphere * (1 - g) * (1 + g)) / (d * Sqrt(d));
    }
    case PhaseShape::hazy:
      return hn::Set(f, 0.5f * per_sphere) * MulAdd(hn::Set(f, 9.0f), eighth(half_plus), hn::Set(f, 1.0f));
    case PhaseShape::murky: {
      VF p = eighth(half_plus);
      p = p * p;
      p = p * p;
      return hn::Set(f, 33.0f / 83.0f * per_sphere) * MulAdd(hn::Set(f, 50.0f), p, hn::Set(f, 1.0f));
    }
  }
  return hn::Set(f, per_sphere);
}

void Scatter(const Scatterer* scatterers, std::size_t count, int channels, std::size_t n, const Incidence& from,
             const float* const* depths, float* const* sums) {
  const F f;
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VF minus = hn::LoadU(f, from.minus + i), plus = hn::LoadU(f, from.plus + i),
             strength = hn::LoadU(f, from.strength + i);
    VF light[3];
    for (int c = 0; c < channels; ++c) {
      VF depth = depths ? hn::LoadU(f, depths[c] + i) : hn::Zero(f);
      for (std::size_t k = 0; k < count; ++k)
        depth = MulAdd(hn::Set(f, scatterers[k].sigma_t[c]), hn::LoadU(f, scatterers[k].column + i), depth);
      light[c] = strength * hn::Exp(f, Neg(depth));
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Scatterer& s = scatterers[k];
      const VF p = phase(s.phase, minus, plus);
      for (int c = 0; c < 3; ++c) {
        const int t = channels == 1 ? 0 : c;
        const VF value = hn::LoadU(f, s.amount[t] + i) * p * light[t];
        hn::StoreU(MulAdd(hn::Set(f, s.colour[c]), value, hn::LoadU(f, sums[c] + i)), f, sums[c] + i);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight::ray_marcher
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::ray_marcher {

HWY_EXPORT(StepWeights);
void step_weights(std::size_t n, const float* before, const float* depth, const float* length, float* weight) {
  HWY_DYNAMIC_DISPATCH(StepWeights)(n, before, depth, length, weight);
}

HWY_EXPORT(Incident);
void incidence(const LightShape& light, std::size_t n, const LitSteps& steps, const Incidence& out) {
  HWY_DYNAMIC_DISPATCH(Incident)(light, n, steps, out);
}

HWY_EXPORT(Scatter);
void scatter(const Scatterer* scatterers, std::size_t count, int channels, std::size_t n, const Incidence& from,
             const float* const* depth, float* const sums[3]) {
  HWY_DYNAMIC_DISPATCH(Scatter)(scatterers, count, channels, n, from, depth, sums);
}

}  // namespace airlight::ray_marcher
#endif
