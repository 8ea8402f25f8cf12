#include "methods/fogshop/paper_ray.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/paper_ray.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "methods/fogshop/erf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

// Lanes are Gaussians; they never exceed the padding of the arrays.
using D = hn::CappedTag<double, GaussianArrays::padding>;
using V = hn::Vec<D>;
constexpr D d;
constexpr hn::RebindToSigned<D> places;

HWY_INLINE V set(double x) { return hn::Set(d, x); }
HWY_INLINE V exp_of(V x) { return hn::Exp(d, hn::Max(x, set(-700))); }

template <Erf kind>
void GaussianTerms(const GaussianArrays& g, const Crossings& c, const Line& view, const PaperLight& light,
                   const double* hue, int channels, double* sums) {
  const V zero = hn::Zero(d), length = set(view.length);
  const V rx = set(view.direction.x()), ry = set(view.direction.y()), rz = set(view.direction.z());
  const V lx = set(light.position.x()), ly = set(light.position.y()), lz = set(light.position.z());
  const Vec3 from_light = view.origin - light.position;
  V sum[3] = {zero, zero, zero};
  for (int first = 0; first < c.count; first += int(hn::Lanes(d))) {
    const auto place = hn::PromoteTo(places, hn::LoadU(hn::Rebind<int, D>(), &c.place[first]));
    const auto of = [&](const std::vector<double>& v) { return hn::GatherIndex(d, v.data(), place); };
    const auto whole_place = hn::PromoteTo(places, hn::GatherIndex(hn::Rebind<int, D>(), g.index.data(),
                                                                   hn::LoadU(hn::Rebind<int, D>(), &c.place[first])));
    const V e = hn::GatherIndex(d, light.exponent.data(), whole_place);
    const V a = hn::LoadU(d, &c.a[first]), m = hn::LoadU(d, &c.middle[first]);
    // Eq. 10: x = b_i^r restricted to the segment, seen from the light.
    const V t = hn::Min(hn::Max(m, zero), length);
    const V sx = hn::MulAdd(t, rx, set(from_light.x())), sy = hn::MulAdd(t, ry, set(from_light.y())),
            sz = hn::MulAdd(t, rz, set(from_light.z()));
    const V dd = hn::MulAdd(sx, sx, hn::MulAdd(sy, sy, hn::Mul(sz, sz)));
    const V distance = hn::Sqrt(dd), inverse = hn::Div(set(1), hn::Max(distance, set(1e-300)));
    const V ux = hn::Mul(sx, inverse), uy = hn::Mul(sy, inverse), uz = hn::Mul(sz, inverse);
    const V qx = hn::Sub(of(g.x), lx), qy = hn::Sub(of(g.y), ly), qz = hn::Sub(of(g.z), lz);
    const V n = hn::MulAdd(qx, ux, hn::MulAdd(qy, uy, hn::Mul(qz, uz)));
    const V px = hn::NegMulAdd(n, ux, qx), py = hn::NegMulAdd(n, uy, qy), pz = hn::NegMulAdd(n, uz, qz);
    const V pp = hn::MulAdd(px, px, hn::MulAdd(py, py, hn::Mul(pz, pz)));
    const V ends = hn::Add(Erf_<kind>(d, hn::Mul(a, hn::Sub(distance, n))), Erf_<kind>(d, hn::Mul(a, n)));
    const V light_depth =
        hn::Mul(hn::Mul(of(g.half_depth), exp_of(hn::Neg(hn::Mul(hn::Mul(a, a), pp)))), hn::Max(ends, zero));
    // Eqs. 11 to 13, exponents added before the exponential.
    const V exponent = hn::Sub(hn::Sub(e, light_depth), hn::LoadU(d, &c.to_nearest[first]));
    const V weight = hn::Div(hn::LoadU(d, &c.whole[first]), hn::Mul(set(4 * pi), hn::Add(dd, set(light.softness))));
    const auto valid = hn::FirstN(d, std::size_t(c.count - first));
    for (int k = 0; k < channels; ++k) {
      V term = hn::Mul(hn::Mul(set(hue[k]), weight), exp_of(hn::Mul(set(hue[k]), exponent)));
      if (g.has_colours()) term = hn::Mul(term, of(g.colour[k]));
      sum[k] = hn::Add(sum[k], hn::IfThenElseZero(valid, term));
    }
  }
  for (int k = 0; k < channels; ++k) sums[k] += hn::GetLane(hn::SumOfLanes(d, sum[k]));
}

void GaussianTermsAny(const GaussianArrays& g, const Crossings& c, const Line& view, const PaperLight& light, Erf erf,
                      const double* hue, int channels, double* sums) {
  if (erf == Erf::precise) return GaussianTerms<Erf::precise>(g, c, view, light, hue, channels, sums);
  if (erf == Erf::erf10) return GaussianTerms<Erf::erf10>(g, c, view, light, hue, channels, sums);
  return GaussianTerms<Erf::paper>(g, c, view, light, hue, channels, sums);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(GaussianTermsAny);

void add_gaussian_terms(const GaussianArrays& gaussians, const Crossings& crossings, const Line& view,
                        const PaperLight& light, Erf erf, const Rgb& hue, bool coloured, Rgb& airlight) {
  HWY_DYNAMIC_DISPATCH(GaussianTermsAny)
  (gaussians, crossings, view, light, erf, hue.data(), coloured ? 3 : 1, airlight.data());
}

}  // namespace airlight::fogshop
#endif
