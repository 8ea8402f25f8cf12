#include "methods/shadow_planes/rule_sum.h"

#include "scene/math/types.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/shadow_planes/rule_sum.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace airlight::shadow_planes::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
constexpr D d;

HWY_INLINE V set(double x) { return hn::Set(d, x); }

// phase_of_halves.
HWY_INLINE V phase_of(const PhaseForm& phase, V v, V w) {
  const auto eighth = [](V x) { return x = x * x, x = x * x, x * x; };
  switch (phase.kind) {
    case PhaseForm::Kind::isotropic:
      break;
    case PhaseForm::Kind::rayleigh: {
      const V c = v - w;
      return set(0.75) * MulAdd(c, c, set(1));
    }
    case PhaseForm::Kind::hazy:
      return set(phase.scale) * MulAdd(set(9), eighth(v), set(1));
    case PhaseForm::Kind::murky: {
      const V v8 = eighth(v), v16 = v8 * v8;
      return set(phase.scale) * MulAdd(set(50), v16 * v16, set(1));
    }
    case PhaseForm::Kind::henyey_greenstein: {
      const double g = phase.g;
      const V r =
          g > 0 ? MulAdd(set(4 * g), w, set((1 - g) * (1 - g))) : MulAdd(set(-4 * g), v, set((1 + g) * (1 + g)));
      return set((1 - g) * (1 + g)) / (r * Sqrt(r));
    }
  }
  return set(1);
}

// Rule for the integral of e^(-a (q - q0)) times the phase function over d theta = 2/(1 + q^2) dq,
// without the factor s1.
double SumOfNodes(const MappedRule<double>& rule, const PhaseForm& phase, double a, const PartMap<double>& map) {
  const V one = set(1), c = set(map.c), q0 = set(map.q0);
  V sum = hn::Zero(d);
  const std::size_t lanes = hn::Lanes(d), count = rule.node.size();
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto inside = hn::FirstN(d, std::min(lanes, count - i));
    const V s = set(map.s1) * hn::MaskedLoad(inside, d, rule.node.data() + i), t = one - s;
    V power = one, series = hn::Zero(d);  // t^m, 1 + t + ... + t^(m-1)
    for (int k = 0; k < rule.m; ++k) {
      series = series + power;
      power = power * t;
    }
    const V inverse = one / (power * t);
    const V further = c * s * (series * t) * inverse;  // q - q0
    const V q = q0 + further, q2 = q * q, v = one / (one + q2), w = q2 * v;
    const V factor = hn::Exp(d, set(-a) * further) * phase_of(phase, v, w);
    sum = MulAdd(hn::MaskedLoad(inside, d, rule.weight.data() + i) * factor, v * inverse, sum);
  }
  return 2 * map.c * rule.m * hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace airlight::shadow_planes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::shadow_planes {

HWY_EXPORT(SumOfNodes);

double isotropic_integral(const MappedRule<double>& rule, const PhaseForm& phase, double extinction, double T, double h,
                          const LitPart<double>& part) {
  const PartMap<double> map = map_part(rule, phase.width(), extinction, extinction, T, h, part);
  if (!(map.h > 0)) return infinity;
  return map.s1 * HWY_DYNAMIC_DISPATCH(SumOfNodes)(rule, phase, extinction * map.h, map) / map.h;
}

}  // namespace airlight::shadow_planes
#endif
