// Approximations of the error function on vectors, included once per instruction set (the guard is Highway's).
#if defined(AIRLIGHT_FOGSHOP_ERF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_FOGSHOP_ERF_INL_H_
#undef AIRLIGHT_FOGSHOP_ERF_INL_H_
#else
#define AIRLIGHT_FOGSHOP_ERF_INL_H_
#endif

#include <hwy/highway.h>

#include "methods/fogshop/kernels.h"
#include "scene/math/erf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <Erf kind>
struct ErfPolynomial;

// Chebyshev interpolation of erf(x)/x in x^2 over [0, 5.2^2], computed with 60 digits; measured error 1.2e-12.
template <>
struct ErfPolynomial<Erf::precise> {
  static constexpr double cut = 5.2, scale = 2 / (5.2 * 5.2);
  static constexpr double coefficient[] = {
      0.2719640924106679,      -0.13598128803926854,    0.10198084091707066,    -0.08496093666408551,
      0.07426274447929226,     -0.06662536692886173,    0.06059771327709239,    -0.05535058194634967,
      0.05033660243511705,     -0.04520778337034483,    0.03980931116022321,    -0.0341211339628217,
      0.02825124110299412,     -0.022643498433179247,   0.0177412939489704,     -0.01311022719475974,
      0.00862439071197275,     -0.00595112711352424,    0.005103337466096544,   -0.0031132657918465155,
      0.0004163799199688446,   -0.00033141222498776134, 0.0014048514253657653,  -0.0007032139093007133,
      -0.00029850098520117123, 0.00013114848454394656,  0.00014913143172554002, -6.705029909432297e-05};
};

// Error 3.8e-6.
template <>
struct ErfPolynomial<Erf::erf10> {
  static constexpr double cut = 3.4, scale = 0.1730103806;
  static constexpr double coefficient[] = {0.415665461,  -0.206107082,  0.149502059,  -0.114526221,
                                           0.0867129074, -0.0639584235, 0.0407177975, -0.0195777336,
                                           0.0134350831, -0.0129474124, 0.00520189239};
};

// Zhou et al. 2007, appendix: error 2.0e-4, most of it at the cut.
template <>
struct ErfPolynomial<Erf::paper> {
  static constexpr double cut = 2.629639, scale = 0.289226;
  static constexpr double coefficient[] = {0.533201, -0.249431, 0.156097, -0.0897001, 0.0503913, -0.0348595, 0.0145688};
};

template <Erf kind, class D, class V = hn::Vec<D>>
HWY_INLINE V Erf_(D d, V x) {
  return airlight::HWY_NAMESPACE::ErfBy<ErfPolynomial<kind>>(d, x);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
