// The arithmetic of one Gaussian along one line, on vectors. Included once per instruction set (the guard is Highway's).
#if defined(AIRLIGHT_FOGSHOP_ARITHMETIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_FOGSHOP_ARITHMETIC_INL_H_
#undef AIRLIGHT_FOGSHOP_ARITHMETIC_INL_H_
#else
#define AIRLIGHT_FOGSHOP_ARITHMETIC_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "methods/fogshop/erf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

// Lanes never exceed the padding of the arrays.
using D = hn::CappedTag<double, GaussianArrays::padding>;
using V = hn::Vec<D>;
constexpr D d;

HWY_INLINE V set(double x) { return hn::Set(d, x); }
HWY_INLINE V load(const std::vector<double>& v, std::size_t i) { return hn::LoadU(d, v.data() + i); }

// exp for arguments that may be as low as -infinity.
HWY_INLINE V exp_of(V x) { return hn::Exp(d, Max(x, set(-700))); }

// The lanes of v where the mask is set, first; the others follow undefined.
HWY_INLINE V compress(V v, hn::Mask<D> mask) {
#if HWY_TARGET == HWY_AVX3
  // Highway 1.0.3 copies a table of 2 KiB to the stack for every call, which takes longer than all that is compressed.
  return V{_mm512_maskz_compress_pd(mask.raw, v.raw)};
#else
  return hn::Compress(v, mask);
#endif
}

struct Vectors {
  V x, y, z;
};
HWY_INLINE V dot(const Vectors& a, const Vectors& b) { return MulAdd(a.x, b.x, MulAdd(a.y, b.y, a.z * b.z)); }

// A centre q, seen from the line's origin, against the line's direction: m along it, and p^2, the squared distance.
struct Projection {
  V middle, squared;
};
HWY_INLINE Projection project(const Vectors& q, const Vectors& direction) {
  const V m = dot(q, direction);
  // The cross product's length: |q|^2 - m^2 would cancel.
  const Vectors p{NegMulAdd(m, direction.x, q.x), NegMulAdd(m, direction.y, q.y), NegMulAdd(m, direction.z, q.z)};
  return {m, dot(p, p)};
}

// -e = -a^2 p^2 of Eq. 31.
HWY_INLINE V peak_exponent(V a, V squared) { return Neg(a * a * squared); }

// erf(a (t - m)) + erf(a m), the latter given: twice the share of the depth that lies in [0, t]. The paper's polynomial
// is not monotone: below 0 it is 0.
template <Erf kind>
HWY_INLINE V share_up_to(V t, V a, V middle, V base) {
  return Max(Erf_<kind>(d, a * (t - middle)) + base, hn::Zero(d));
}

// Eqs. 10 to 13 for one Gaussian and one light, but for the extinction ratio: the term is weight exp(exponent).
struct PaperTerm {
  V weight, exponent;
};
// 4 pi times Henyey-Greenstein's phase function, of light that goes along a direction whose cosine with the view ray is
// given, towards the viewer.
HWY_INLINE V phase_of(double g, V along) {
  const V square = MulAdd(set(2 * g), along, set(1 + g * g));
  return set(1 - g * g) / (square * Sqrt(square));
}

// `center` and `nearest` (b_i^r) as seen from the light; `own` is the light's E_i (PaperLight), `softness` r_s^2.
template <Erf kind>
HWY_INLINE PaperTerm paper_term(const Vectors& center, const Vectors& nearest, V a, V half_depth, V own, V to_nearest,
                                V whole, V softness) {
  const V squared = dot(nearest, nearest), distance = Sqrt(squared);
  const V inverse = set(1) / Max(distance, set(1e-300));
  const Projection p = project(center, {nearest.x * inverse, nearest.y * inverse, nearest.z * inverse});
  const V base = Erf_<kind>(d, a * p.middle);
  const V light_depth =
      half_depth * exp_of(peak_exponent(a, p.squared)) * share_up_to<kind>(distance, a, p.middle, base);
  // Exponents are added before the exponential: each alone may overflow.
  return {whole / (set(4 * pi) * (squared + softness)), own - light_depth - to_nearest};
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
