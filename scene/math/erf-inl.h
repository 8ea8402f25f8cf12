// The error function on vectors, included once per instruction set (the guard is Highway's).
#if defined(AIRLIGHT_ERF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_ERF_INL_H_
#undef AIRLIGHT_ERF_INL_H_
#else
#define AIRLIGHT_ERF_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace airlight::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// x times a polynomial in z = scale x^2 - 1, which runs over [-1, 1] up to a cut, and +-1 beyond it. P has cut, scale = 2 / cut^2, and the
// coefficients of z^0, z^1, ...
template <class P, class D, class V = hn::Vec<D>>
HWY_INLINE V ErfBy(D d, V x) {
  constexpr int n = int(std::size(P::coefficient));
  const auto c = [&](int i) { return hn::Set(d, P::coefficient[i]); };
  const V magnitude = Abs(x);
  const V xc = Min(magnitude, hn::Set(d, P::cut));
  const V z = MulSub(xc * xc, hn::Set(d, P::scale), hn::Set(d, 1.0));
  // Even and odd powers apart: two chains of half the length.
  const V zz = z * z;
  V upper = c(n - 1), lower = c(n - 2);
  for (int i = n - 3; i >= 0; i -= 2) {
    upper = MulAdd(upper, zz, c(i));
    if (i > 0) lower = MulAdd(lower, zz, c(i - 1));
  }
  constexpr bool even = (n - 1) % 2 == 0;  // of the power that `upper` began with
  const V sum = even ? MulAdd(lower, z, upper) : MulAdd(upper, z, lower);
  const V one = hn::Set(d, 1.0);
  const V value = Min(xc * sum, one);
  return hn::CopySign(IfThenElse(magnitude > hn::Set(d, P::cut), one, value), x);
}

}  // namespace airlight::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
