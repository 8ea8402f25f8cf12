#include "methods/fogshop/paper_ray.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/paper_ray.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "methods/fogshop/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

constexpr hn::Rebind<int, D> integers;
constexpr hn::RebindToSigned<D> long_integers;

// Lanes are Gaussians.
template <Erf kind>
void GaussianTerms(const GaussianArrays& g, const Crossings& c, const Line& view, const PaperLight& light,
                   const double* extinction_ratio, int channels, double* sums) {
  const V zero = hn::Zero(d), length = set(view.length), softness = set(light.softness);
  const Vec3 from_light = view.origin - light.position;
  V sum[3] = {zero, zero, zero};
  for (std::size_t first = 0; first < std::size_t(c.count); first += hn::Lanes(d)) {
    const auto gather = [&](const std::vector<double>& from, const std::vector<int>& places) {
      return hn::GatherIndex(d, from.data(), hn::PromoteTo(long_integers, hn::LoadU(integers, &places[first])));
    };
    const V own = gather(light.exponent, c.index);
    const Vectors center{load(c.x, first) - set(light.position.x()), load(c.y, first) - set(light.position.y()),
                         load(c.z, first) - set(light.position.z())};
    // Eq. 10: b_i^r restricted to the segment.
    const V t = Min(Max(load(c.middle, first), zero), length);
    const Vectors nearest{MulAdd(t, set(view.direction.x()), set(from_light.x())),
                          MulAdd(t, set(view.direction.y()), set(from_light.y())),
                          MulAdd(t, set(view.direction.z()), set(from_light.z()))};
    const PaperTerm p = paper_term<kind>(center, nearest, load(c.a, first), load(c.half_depth, first), own,
                                         load(c.to_nearest, first), load(c.whole, first), softness);
    V weight = p.weight;
    if (light.g != 0) {  // k(alpha) of Eq. 12
      const V along = MulAdd(nearest.x, set(view.direction.x()),
                             MulAdd(nearest.y, set(view.direction.y()), nearest.z * set(view.direction.z())));
      weight = weight * phase_of(light.g, along / Max(Sqrt(dot(nearest, nearest)), set(1e-300)));
    }
    const auto valid = hn::FirstN(d, c.count - first);
    for (int k = 0; k < channels; ++k) {
      V term = set(extinction_ratio[k]) * weight * exp_of(set(extinction_ratio[k]) * p.exponent);
      if (g.has_colours()) term = term * gather(g.colour[k], c.place);
      sum[k] = sum[k] + IfThenElseZero(valid, term);
    }
  }
  for (int k = 0; k < channels; ++k) sums[k] += hn::GetLane(hn::SumOfLanes(d, sum[k]));
}

void GaussianTermsAny(const GaussianArrays& g, const Crossings& c, const Line& view, const PaperLight& light, Erf erf,
                      const double* extinction_ratio, int channels, double* sums) {
  if (erf == Erf::precise) return GaussianTerms<Erf::precise>(g, c, view, light, extinction_ratio, channels, sums);
  if (erf == Erf::erf10) return GaussianTerms<Erf::erf10>(g, c, view, light, extinction_ratio, channels, sums);
  return GaussianTerms<Erf::paper>(g, c, view, light, extinction_ratio, channels, sums);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(GaussianTermsAny);

void add_gaussian_terms(const GaussianArrays& gaussians, const Crossings& crossings, const Line& view,
                        const PaperLight& light, Erf erf, const Rgb& extinction_ratio, bool coloured, Rgb& airlight) {
  HWY_DYNAMIC_DISPATCH(GaussianTermsAny)
  (gaussians, crossings, view, light, erf, extinction_ratio.data(), coloured ? 3 : 1, airlight.data());
}

}  // namespace airlight::fogshop
#endif
