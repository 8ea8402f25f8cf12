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
  const V one = hn::Set(d, 1.0), limit = hn::Set(d, DawsonFit::end), v = Min(w, limit);
  V p = hn::Set(d, DawsonFit::numerator[9]), q = hn::Set(d, DawsonFit::denominator[9]);
  for (int k = 8; k >= 0; --k) {
    p = MulAdd(p, v, hn::Set(d, DawsonFit::numerator[k]));
    q = MulAdd(q, v, hn::Set(d, DawsonFit::denominator[k]));
  }
  const V near = p / MulAdd(q, v, one);
  const auto far = w >= limit;
  if (hn::AllFalse(d, far)) return near;
  const V over = hn::Set(d, 0.5) / Max(w, limit);
  V tail = MulAdd(over, hn::Set(d, 5.0), one);
  tail = MulAdd(over * hn::Set(d, 3.0), tail, one);
  return IfThenElse(far, over * MulAdd(over, tail, one), near);
}

double SumAverageDepths(const GaussianArrays& g, int begin, int end, const Point3& point) {
  constexpr D d;
  const int lanes = int(hn::Lanes(d));
  const V px = hn::Set(d, point.x()), py = hn::Set(d, point.y()), pz = hn::Set(d, point.z());
  V sum = hn::Zero(d);
  for (int i = begin; i < end; i += lanes) {
    const V x = hn::LoadU(d, &g.x[i]) - px, y = hn::LoadU(d, &g.y[i]) - py, z = hn::LoadU(d, &g.z[i]) - pz,
            a = hn::LoadU(d, &g.a[i]);
    const V square = MulAdd(x, x, MulAdd(y, y, z * z));
    const V term = hn::LoadU(d, &g.half_depth[i]) * DawsonOver(a * a * square);
    sum = sum + IfThenElseZero(hn::FirstN(d, std::size_t(end - i)), term);
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
