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

double SumAverageDepths(const GaussianArrays& g, const Point3& point, const double* nodes, int count) {
  constexpr D d;
  constexpr hn::Rebind<std::int64_t, D> integers;
  const V px = hn::Set(d, point.x()), py = hn::Set(d, point.y()), pz = hn::Set(d, point.z()), one = hn::Set(d, 1.0);
  const V end = hn::Set(d, AverageDepthNode::end), per_unit = hn::Set(d, count / AverageDepthNode::end);
  const V series[] = {hn::Set(d, 1.0), hn::Set(d, 3.0), hn::Set(d, 15.0), hn::Set(d, 105.0), hn::Set(d, 945.0)};
  V sum = hn::Zero(d);
  for (int i = 0; i < g.count; i += int(hn::Lanes(d))) {
    const V x = hn::Sub(hn::LoadU(d, &g.x[i]), px), y = hn::Sub(hn::LoadU(d, &g.y[i]), py),
            z = hn::Sub(hn::LoadU(d, &g.z[i]), pz);
    const V u = hn::Mul(hn::LoadU(d, &g.a[i]), hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)))));
    // Cubic between values and slopes.
    const V place = hn::Mul(hn::Min(u, end), per_unit);
    const V k = hn::Min(hn::Floor(place), hn::Set(d, count - 1.0));
    const V s = hn::Sub(place, k), r = hn::Sub(one, s);
    const auto at = hn::ShiftLeft<1>(hn::ConvertTo(integers, k));
    const V value = hn::GatherIndex(d, nodes, at), slope = hn::GatherIndex(d, nodes + 1, at);
    const V next = hn::GatherIndex(d, nodes + 2, at), next_slope = hn::GatherIndex(d, nodes + 3, at);
    const V low = hn::MulAdd(value, hn::MulAdd(s, hn::Set(d, 2.0), one), hn::Mul(slope, s));
    const V high = hn::MulSub(next, hn::MulAdd(r, hn::Set(d, 2.0), one), hn::Mul(next_slope, r));
    V f = hn::MulAdd(hn::Mul(r, r), low, hn::Mul(hn::Mul(s, s), high));
    if (const auto far = hn::Ge(u, end); !hn::AllFalse(d, far)) {
      const V inverse = hn::Div(one, hn::Mul(u, u)), w = hn::Mul(inverse, hn::Set(d, 0.5));
      V tail = series[4];
      for (int n = 3; n >= 0; --n) tail = hn::MulAdd(tail, w, series[n]);
      tail = hn::MulAdd(tail, w, one);
      f = hn::IfThenElse(far, hn::Mul(hn::Mul(inverse, tail), hn::Set(d, 0.25 * std::sqrt(pi))), f);
    }
    const V term = hn::Mul(hn::LoadU(d, &g.half_depth[i]), f);
    sum = hn::Add(sum, hn::IfThenElseZero(hn::FirstN(d, std::size_t(g.count - i)), term));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(SumAverageDepths);

double average_depth_of(const GaussianArrays& gaussians, const Point3& point) {
  static_assert(sizeof(AverageDepthNode) == 2 * sizeof(double));
  static const std::vector<AverageDepthNode>& nodes = average_depth_nodes();
  // half_depth is c sqrt(pi) / (2 a).
  return 2 / std::sqrt(pi) *
         HWY_DYNAMIC_DISPATCH(SumAverageDepths)(gaussians, point, &nodes[0].value, int(nodes.size()) - 1);
}

}  // namespace airlight::fogshop
#endif
