#include "methods/fogshop/edges.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/edges.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "methods/fogshop/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

constexpr hn::Rebind<int, D> integers;
constexpr hn::RebindToSigned<D> long_integers;

// `steps` points at angles that are even between those of lo and hi, `span` apart, as seen from the light.
void EvenAngles(double lo, double hi, double along, double h, double span, int steps, double* nodes) {
  const double xa = lo - along, turn = span / (steps + 1);
  // The vector (h, xa) points at lo; turned by 1, 2, ... 8 steps in the lanes, then by 8 at once.
  alignas(64) double cosine[8] = {std::cos(turn)}, sine[8] = {std::sin(turn)};
  for (int k = 1; k < 8; ++k) {
    const int a = (k - 1) / 2, b = k - 1 - a;  // a + 1 and b + 1 steps are k + 1
    cosine[k] = cosine[a] * cosine[b] - sine[a] * sine[b];
    sine[k] = cosine[a] * sine[b] + sine[a] * cosine[b];
  }
  const std::size_t lanes = hn::Lanes(d);
  const V step_cosine = set(cosine[lanes - 1]), step_sine = set(sine[lanes - 1]);
  V x = set(h) * hn::Load(d, cosine) - set(xa) * hn::Load(d, sine);
  V y = set(h) * hn::Load(d, sine) + set(xa) * hn::Load(d, cosine);
  for (int k = 0; k < steps; k += int(lanes)) {
    const auto ahead = x > hn::Zero(d);
    const V t = MulAdd(set(h), y / IfThenElse(ahead, x, set(1)), set(along));
    hn::StoreU(IfThenElse(ahead, Min(Max(t, set(lo)), set(hi)), set(hi)), d, nodes + k);
    const V turned = x * step_cosine - y * step_sine;
    y = x * step_sine + y * step_cosine;
    x = turned;
  }
}

// Ramps from 0 to the weight over each box; returns the sum of the weights. A box weighs as much as its Gaussian takes
// from the ray.
double BoxRamps(const Crossings& c, double* weight, double* slope, double* offset) {
  V sum = hn::Zero(d);
  for (std::size_t i = 0; i < std::size_t(c.count); i += hn::Lanes(d)) {
    const V opacity = set(1) - exp_of(set(-2) * load(c.depth, i));
    const V w = IfThenElseZero(hn::FirstN(d, c.count - i), opacity), g = load(c.a, i) * set(1 / 3.2);
    hn::StoreU(w, d, weight + i);
    hn::StoreU(w * g, d, slope + i);
    hn::StoreU(w * NegMulAdd(load(c.middle, i), g, set(0.5)), d, offset + i);
    sum = sum + w;
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

// share[k] = scale times the parts of the boxes that lie before node k.
void BoxShares(const double* node, int count, const EdgeScratch& boxes, int n, double scale, double* share) {
  const int lanes = int(hn::Lanes(d));
  // Several vectors of nodes for each box that is fetched; the nodes are padded for that.
  for (int k = 0; k < count; k += 4 * lanes) {
    V sum[4], t[4];
    for (int j = 0; j < 4; ++j) sum[j] = hn::Zero(d), t[j] = hn::LoadU(d, node + k + j * lanes);
    for (int i = 0; i < n; ++i) {
      const V weight = set(boxes.weight[i]), slope = set(boxes.slope[i]), offset = set(boxes.offset[i]);
      for (int j = 0; j < 4; ++j) sum[j] = sum[j] + Min(Max(MulAdd(t[j], slope, offset), hn::Zero(d)), weight);
    }
    for (int j = 0; j < 4; ++j) hn::StoreU(set(scale) * sum[j], d, share + k + j * lanes);
  }
}

// share[k] += weight (node k - lo) and what the lights add.
void AddShares(const double* node, int count, double lo, double weight, const AngleShare* lights, std::size_t n,
               double* share) {
  for (int k = 0; k < count; k += int(hn::Lanes(d))) {
    const V t = hn::LoadU(d, node + k);
    V sum = MulAdd(t - set(lo), set(weight), hn::LoadU(d, share + k));
    for (std::size_t l = 0; l < n; ++l) {
      const V angle = hn::Atan(d, (t - set(lights[l].along)) * set(1 / lights[l].h));
      sum = MulAdd(set(lights[l].weight), angle - set(lights[l].first), sum);
    }
    hn::StoreU(sum, d, share + k);
  }
}

// rank[k]: how many steps of 1/scale node k lies above `first`, rounded up to a whole number in [0, last].
void Ranks(const double* share, int count, double first, double scale, int last, int* rank) {
  for (int k = 0; k < count; k += int(hn::Lanes(d))) {
    const V r = hn::Ceil((hn::LoadU(d, share + k) - set(first)) * set(scale));
    hn::StoreU(hn::DemoteTo(integers, Min(Max(r, hn::Zero(d)), set(last))), integers, rank + k);
  }
}

// t[i], i = 0 ... slices - 1, where the line between nodes before[i] and before[i] + 1 reaches first + i step.
void Invert(const double* node, const double* share, const int* before, int slices, double first, double step,
            double* t) {
  for (int i = 0; i < slices; i += int(hn::Lanes(d))) {
    const auto place = hn::PromoteTo(long_integers, hn::LoadU(integers, before + i));
    const V n0 = hn::GatherIndex(d, node, place), n1 = hn::GatherIndex(d, node + 1, place);
    const V s0 = hn::GatherIndex(d, share, place), s1 = hn::GatherIndex(d, share + 1, place);
    const V wanted = MulAdd(hn::Iota(d, double(i)), set(step), set(first));
    const V s = (wanted - s0) / Max(s1 - s0, set(1e-300));
    hn::StoreU(MulAdd(Min(Max(s, hn::Zero(d)), set(1)), n1 - n0, n0), d, t + i);
  }
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(EvenAngles);
HWY_EXPORT(BoxRamps);
HWY_EXPORT(BoxShares);
HWY_EXPORT(AddShares);
HWY_EXPORT(Ranks);
HWY_EXPORT(Invert);

namespace {

constexpr double least_h = 1e-9;  // [m]

// The nodes of the lights and `even` + 1 even ones in [lo, hi], in order. Even nodes are the buckets of a counting
// sort; within a bucket the few of one light are in order already. Returns their number.
int merge_nodes(double lo, double hi, int even, int angles, EdgeScratch& s) {
  std::vector<int>& bucket = s.bucket;
  bucket.assign(even + 1, 0);
  const double scale = even / (hi - lo);
  const auto bucket_of = [&](double t) { return std::clamp(int((t - lo) * scale), 0, even - 1); };
  for (int j = 0; j < angles; ++j) ++bucket[bucket_of(s.angle[j])];
  // From sizes to the place after each bucket's even node.
  int next = 0;
  for (int i = 0; i <= even; ++i) {
    s.node[next] = lo + (hi - lo) * i / even;
    const int size = bucket[i];
    bucket[i] = ++next;
    next += size;
  }
  for (int j = 0; j < angles; ++j) s.node[bucket[bucket_of(s.angle[j])]++] = s.angle[j];
  for (int k = 1; k < next; ++k)
    for (int j = k; j > 0 && s.node[j] < s.node[j - 1]; --j) std::swap(s.node[j], s.node[j - 1]);
  s.node[0] = lo;
  s.node[next - 1] = hi;
  return next;
}

}  // namespace

void place_edges(double lo, double hi, const std::vector<LightFromRay>& lights, const Crossings* boxes, int slices,
                 EdgeScratch& s, double* t) {
  // The mixture's distribution function is evaluated at nodes, and inverted by lines between them. The nodes follow the
  // same distributions as the edges, so that the lines are short where the edges will be dense.
  constexpr int padding = GaussianArrays::padding;
  const int even = slices + slices / 2, per_light = lights.empty() ? 0 : std::max(8, slices / int(lights.size()));
  const int angles = per_light * int(lights.size());
  s.angle.resize(angles + padding);
  s.node.assign(even + 1 + angles + 4 * padding, hi);
  s.share.assign(s.node.size(), 0.0);
  s.lights.clear();
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const double along = lights[l].along, h = std::max(lights[l].h, least_h), xa = lo - along, xb = hi - along;
    const double span = std::atan2(h * (hi - lo), h * h + xa * xb);
    HWY_DYNAMIC_DISPATCH(EvenAngles)(lo, hi, along, h, span, per_light, &s.angle[l * per_light]);
    s.lights.push_back({along, h, std::atan(xa / h), span > 0 ? 1 / span : 0});
  }
  const int count = merge_nodes(lo, hi, even, angles, s);

  double opacity = 0;
  if (boxes) {
    for (auto* v : {&s.weight, &s.slope, &s.offset}) v->resize(boxes->count + padding);
    opacity = HWY_DYNAMIC_DISPATCH(BoxRamps)(*boxes, s.weight.data(), s.slope.data(), s.offset.data());
  }
  const double parts = 1.0 + !lights.empty() + (opacity > 0);
  for (AngleShare& light : s.lights) light.weight /= parts * double(lights.size());
  if (boxes && opacity > 0) HWY_DYNAMIC_DISPATCH(BoxShares)
  (s.node.data(), count, s, boxes->count, 1 / (parts * opacity), s.share.data());
  HWY_DYNAMIC_DISPATCH(AddShares)
  (s.node.data(), count, lo, 1 / ((hi - lo) * parts), s.lights.data(), s.lights.size(), s.share.data());

  // The last node below each edge: nodes leave their number at the first edge that they do not lie beyond.
  const double first = s.share[0], step = (s.share[count - 1] - first) / slices;
  s.rank.resize(count + padding);
  HWY_DYNAMIC_DISPATCH(Ranks)(s.share.data(), count, first, 1 / step, slices, s.rank.data());
  s.before.assign(slices + 1 + padding, 0);
  for (int k = 0; k + 1 < count; ++k) s.before[s.rank[k]] = k;
  for (int i = 1; i <= slices; ++i) s.before[i] = std::max(s.before[i], s.before[i - 1]);
  HWY_DYNAMIC_DISPATCH(Invert)(s.node.data(), s.share.data(), s.before.data(), slices, first, step, t);
  t[0] = lo;
  t[slices] = hi;
}

}  // namespace airlight::fogshop
#endif
