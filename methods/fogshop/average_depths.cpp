#include "methods/fogshop/average_depths.h"

#include <cmath>

#include "methods/fogshop/surface_psf.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/average_depths.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, GaussianArrays::padding>;
using V = hn::Vec<D>;

// D(u)/u for w = u^2.
V DawsonOver(V w) {
  constexpr D d;
  const V one = hn::Set(d, 1.0), limit = hn::Set(d, DawsonFit::end), v = hn::Min(w, limit);
  V p = hn::Set(d, DawsonFit::numerator[9]), q = hn::Set(d, DawsonFit::denominator[9]);
  for (int k = 8; k >= 0; --k) {
    p = hn::MulAdd(p, v, hn::Set(d, DawsonFit::numerator[k]));
    q = hn::MulAdd(q, v, hn::Set(d, DawsonFit::denominator[k]));
  }
  const V near = hn::Div(p, hn::MulAdd(q, v, one));
  const auto far = hn::Ge(w, limit);
  if (hn::AllFalse(d, far)) return near;
  const V over = hn::Div(hn::Set(d, 0.5), hn::Max(w, limit));
  V tail = hn::MulAdd(over, hn::Set(d, 5.0), one);
  tail = hn::MulAdd(hn::Mul(over, hn::Set(d, 3.0)), tail, one);
  return hn::IfThenElse(far, hn::Mul(over, hn::MulAdd(over, tail, one)), near);
}

double SumAverageDepths(const GaussianArrays& g, int begin, int end, const Point3& point) {
  constexpr D d;
  const int lanes = int(hn::Lanes(d));
  const V px = hn::Set(d, point.x()), py = hn::Set(d, point.y()), pz = hn::Set(d, point.z());
  V sum = hn::Zero(d);
  for (int i = begin; i < end; i += lanes) {
    const V x = hn::Sub(hn::LoadU(d, &g.x[i]), px), y = hn::Sub(hn::LoadU(d, &g.y[i]), py),
            z = hn::Sub(hn::LoadU(d, &g.z[i]), pz), a = hn::LoadU(d, &g.a[i]);
    const V square = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const V term = hn::Mul(hn::LoadU(d, &g.half_depth[i]), DawsonOver(hn::Mul(hn::Mul(a, a), square)));
    sum = hn::Add(sum, hn::IfThenElseZero(hn::FirstN(d, std::size_t(end - i)), term));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(SumAverageDepths);

double average_depth_of(const GaussianArrays& gaussians, const Point3& point) {
  return average_depth_of(gaussians, 0, gaussians.count, point);
}

double average_depth_of(const GaussianArrays& gaussians, int begin, int end, const Point3& point) {
  return HWY_DYNAMIC_DISPATCH(SumAverageDepths)(gaussians, begin, end, point);
}

}  // namespace airlight::fogshop
#endif
