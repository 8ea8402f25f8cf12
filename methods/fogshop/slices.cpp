#include "methods/fogshop/slices.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/slices.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, GaussianArrays::padding>;
using V = hn::Vec<D>;
constexpr D d;

HWY_INLINE V set(double x) { return hn::Set(d, x); }

// Angle of (x, y) for y >= 0, in [0, pi].
HWY_INLINE V angle_of(V y, V x) {
  const V zero = hn::Zero(d);
  const V slope = hn::Div(y, hn::IfThenElse(hn::Eq(x, zero), set(1e-300), x));
  const V angle = hn::Atan(d, hn::Min(hn::Max(slope, set(-1e300)), set(1e300)));
  return hn::IfThenElse(hn::Lt(x, zero), hn::Add(angle, set(pi)), angle);
}

// share[k] += weight (angle of node k - first) / span, the angle as seen from the light.
void AddAngleShare(const double* node, int count, double along, double h, double weight, double first, double span,
                   double* share) {
  const V inverse = set(1 / h), scale = set(weight / span);
  for (int k = 0; k < count; k += int(hn::Lanes(d))) {
    const V slope = hn::Mul(hn::Sub(hn::LoadU(d, node + k), set(along)), inverse);
    const V angle = hn::Sub(hn::Atan(d, slope), set(first));
    hn::StoreU(hn::MulAdd(scale, angle, hn::LoadU(d, share + k)), d, share + k);
  }
}

// share[k] += the part of the boxes that lies before node k.
void AddBoxShare(const double* node, int count, const Crossings& c, const double* weight, double* share) {
  for (int k = 0; k < count; k += int(hn::Lanes(d))) {
    const V t = hn::LoadU(d, node + k);
    V sum = hn::LoadU(d, share + k);
    for (int i = 0; i < c.count; ++i) {
      const V s = hn::MulAdd(hn::Sub(t, set(c.middle[i])), set(c.a[i] / 3.2), set(0.5));
      sum = hn::MulAdd(set(weight[i]), hn::Min(hn::Max(s, hn::Zero(d)), set(1)), sum);
    }
    hn::StoreU(sum, d, share + k);
  }
}

void Slices(const double* t, const double* view_depth, const double* light_depth, const double* const* scattering,
            int slices, double along, double h, const double* hue, int channels, double* sums) {
  const V zero = hn::Zero(d);
  V sum[3] = {zero, zero, zero};
  for (int k = 0; k < slices; k += int(hn::Lanes(d))) {
    const V t0 = hn::LoadU(d, t + k), t1 = hn::LoadU(d, t + k + 1);
    const V length = hn::Sub(t1, t0), xa = hn::Sub(t0, set(along)), xb = hn::Sub(t1, set(along));
    // Integral of dt / (x^2 + h^2) over the slice, from the angle between its ends, which does not cancel.
    const V angle = angle_of(hn::Mul(set(h), length), hn::MulAdd(xa, xb, set(h * h)));
    const V valid_length = hn::Max(length, set(1e-300));
    const V mean_inverse_square = hn::Div(angle, hn::Mul(set(h), valid_length));
    const V a0 = hn::LoadU(d, view_depth + k), a1 = hn::LoadU(d, view_depth + k + 1);
    const V b0 = hn::LoadU(d, light_depth + k), b1 = hn::LoadU(d, light_depth + k + 1);
    const V step = hn::Max(hn::Sub(a1, a0), zero);
    const V s0 = hn::Add(a0, b0), s1 = hn::Add(a1, b1);
    const auto used = hn::And(hn::FirstN(d, std::size_t(slices - k)), hn::Gt(length, zero));
    for (int c = 0; c < channels; ++c) {
      const V e0 = hn::Exp(d, hn::Max(hn::Mul(set(-hue[c]), s0), set(-700)));
      const V e1 = hn::Exp(d, hn::Max(hn::Mul(set(-hue[c]), s1), set(-700)));
      // Mean of e^-s where s goes from s0 to s1 linearly: the depth from the light may fall as that from the view
      // grows.
      const V q = hn::Mul(set(hue[c]), hn::Sub(s1, s0));
      const auto small = hn::Lt(hn::Abs(q), set(1e-3));
      const V series = hn::MulAdd(q, hn::MulAdd(q, hn::MulAdd(q, set(-1.0 / 24), set(1.0 / 6)), set(-0.5)), set(1));
      const V mean =
          hn::IfThenElse(small, hn::Mul(e0, series), hn::Div(hn::Sub(e0, e1), hn::IfThenElse(small, set(1), q)));
      V scattered = step;
      if (scattering)
        scattered = hn::Max(hn::Sub(hn::LoadU(d, scattering[c] + k + 1), hn::LoadU(d, scattering[c] + k)), zero);
      const V slice = hn::Mul(hn::Mul(mean_inverse_square, hn::Mul(set(hue[c]), scattered)), mean);
      sum[c] = hn::Add(sum[c], hn::IfThenElseZero(used, slice));
    }
  }
  for (int c = 0; c < channels; ++c) sums[c] += hn::GetLane(hn::SumOfLanes(d, sum[c])) / (4 * pi);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(AddAngleShare);
HWY_EXPORT(AddBoxShare);
HWY_EXPORT(Slices);

namespace {

constexpr double least_h = 1e-9;  // [m]

// Appends `steps` points in (lo, hi) at even angles as seen from the light, in order.
void even_angles(double lo, double hi, const LightFromRay& light, double h, int steps, std::vector<double>& nodes) {
  const double xa = lo - light.along, xb = hi - light.along;
  const double turn = std::atan2(h * (hi - lo), h * h + xa * xb) / (steps + 1);
  const double cosine = std::cos(turn), sine = std::sin(turn);
  double x = h, y = xa;  // a vector at the angle of the node, turned step by step
  for (int k = 0; k < steps; ++k) {
    const double turned = x * cosine - y * sine;
    y = x * sine + y * cosine;
    x = turned;
    const double t = x > 0 ? light.along + h * (y / x) : hi;
    nodes.push_back(std::clamp(t, k > 0 ? nodes.back() : lo, hi));
  }
}

}  // namespace

void place_edges(double lo, double hi, const std::vector<LightFromRay>& lights, const Crossings* boxes, int slices,
                 EdgeScratch& scratch, double* t) {
  // The mixture's distribution function is evaluated at nodes, and inverted by lines between them. The nodes follow the
  // same distributions as the edges, so that the lines are short where the edges will be dense.
  std::vector<double>& node = scratch.node;
  node.clear();
  const int even = slices + slices / 2;
  for (int k = 0; k <= even; ++k) node.push_back(lo + (hi - lo) * k / even);
  node.back() = hi;
  for (const LightFromRay& light : lights) {
    const std::size_t begin = node.size();
    even_angles(lo, hi, light, std::max(light.h, least_h), std::max(8, slices / int(lights.size())), node);
    scratch.merged.resize(node.size());
    std::merge(node.begin(), node.begin() + begin, node.begin() + begin, node.end(), scratch.merged.begin());
    node.swap(scratch.merged);
  }
  const int count = int(node.size());
  node.resize(count + GaussianArrays::padding, hi);

  std::vector<double>& share = scratch.share;
  share.assign(node.size(), 0.0);
  // A box weighs as much as its Gaussian takes from the ray.
  double total_opacity = 0;
  scratch.box.clear();
  for (int i = 0; boxes && i < boxes->count; ++i) {
    scratch.box.push_back(1 - std::exp(-2 * boxes->depth[i]));
    total_opacity += scratch.box.back();
  }
  const double parts = 1.0 + !lights.empty() + (total_opacity > 0);
  for (int k = 0; k < count; ++k) share[k] = (node[k] - lo) / ((hi - lo) * parts);
  for (const LightFromRay& light : lights) {
    const double h = std::max(light.h, least_h), xa = lo - light.along, xb = hi - light.along;
    const double span = std::atan2(h * (hi - lo), h * h + xa * xb);
    if (!(span > 0)) continue;
    HWY_DYNAMIC_DISPATCH(AddAngleShare)
    (node.data(), count, light.along, h, 1 / (parts * lights.size()), std::atan(xa / h), span, share.data());
  }
  if (total_opacity > 0) {
    for (double& weight : scratch.box) weight /= parts * total_opacity;
    HWY_DYNAMIC_DISPATCH(AddBoxShare)(node.data(), count, *boxes, scratch.box.data(), share.data());
  }

  const double first = share[0], total = share[count - 1] - first;
  int k = 0;
  for (int i = 1; i < slices; ++i) {
    const double wanted = first + total * i / slices;
    while (k + 2 < count && share[k + 1] < wanted) ++k;
    const double step = share[k + 1] - share[k];
    const double s = step > 0 ? std::clamp((wanted - share[k]) / step, 0.0, 1.0) : 0;
    t[i] = node[k] + s * (node[k + 1] - node[k]);
  }
  t[0] = lo;
  t[slices] = hi;
}

void every_other(const std::vector<double>& all, int slices, std::vector<double>& half) {
  half.assign(std::size_t(slices) / 2 + 1 + GaussianArrays::padding, all[slices]);
  for (int k = 0; k <= slices / 2; ++k) half[k] = all[2 * k];
}

void add_slices(const double* t, const double* view_depth, const double* light_depth, const double* const* scattering,
                int slices, const LightFromRay& light, double source_radius, const Rgb& hue, bool coloured,
                Rgb& airlight) {
  const double h = std::max(std::hypot(light.h, source_radius), least_h);
  HWY_DYNAMIC_DISPATCH(Slices)
  (t, view_depth, light_depth, scattering, slices, light.along, h, hue.data(), coloured ? 3 : 1, airlight.data());
}

}  // namespace airlight::fogshop
#endif
