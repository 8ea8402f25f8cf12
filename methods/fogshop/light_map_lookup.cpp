#include "methods/fogshop/light_map_lookup.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/light_map_lookup.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
constexpr D d;
constexpr DI di;

HWY_INLINE V set(double x) { return hn::Set(d, x); }

struct Pair {
  V first, second;
};

// Two neighbouring floats at each place.
HWY_INLINE Pair load_pair(const float* depths, VI place) {
  const auto both = hn::GatherOffset(di, reinterpret_cast<const int64_t*>(depths), hn::ShiftLeft<2>(place));
  const hn::Rebind<float, D> single;
  const auto low = hn::TruncateTo(hn::Rebind<uint32_t, D>(), hn::BitCast(hn::RebindToUnsigned<D>(), both));
  const auto high =
      hn::TruncateTo(hn::Rebind<uint32_t, D>(), hn::ShiftRight<32>(hn::BitCast(hn::RebindToUnsigned<D>(), both)));
  return {hn::PromoteTo(d, hn::BitCast(single, low)), hn::PromoteTo(d, hn::BitCast(single, high))};
}

HWY_INLINE V lerp(V a, V b, V s) { return MulAdd(b - a, s, a); }

// x = whole + rest with whole in [0, last]; the whole number is returned.
HWY_INLINE V split(V x, int last, V& rest) {
  const V whole = Min(Max(Floor(x), hn::Zero(d)), set(last));
  rest = x - whole;
  return whole;
}

void LookUp(const MapLookup& map, const double* start, const double* step, const double* t, int count, double* depth) {
  const V zero = hn::Zero(d), one = set(1);
  const int side = map.directions + 2;
  const int64_t stride = map.edges + 1, row = stride * side;
  const bool even = map.near > 0;
  const V to_edge = set(map.far > map.near ? 1 / (map.far - map.near) : 0);
  for (int n = 0; n < count; n += int(hn::Lanes(d))) {
    const V tn = hn::LoadU(d, t + n);
    const V x = MulAdd(tn, set(step[0]), set(start[0])), y = MulAdd(tn, set(step[1]), set(start[1])),
            z = MulAdd(tn, set(step[2]), set(start[2]));
    const V distance = Sqrt(MulAdd(x, x, MulAdd(y, y, z * z)));
    V px, py;
    auto seen = distance > set(map.near);
    if (map.tangent > 0) {
      seen = And(seen, z > zero);
      const V scale = set(1 / map.tangent) / IfThenElse(z > zero, z, one);
      px = x * scale;
      py = y * scale;
      seen = And(seen, Max(Abs(px), Abs(py)) <= one);
    } else {
      const V sum = Abs(x) + Abs(y) + Abs(z);
      const V scale = one / Max(sum, set(1e-300));
      px = x * scale;
      py = y * scale;
      // The lower half is folded over the diagonals.
      const auto lower = z < zero;
      const V fx = hn::CopySign(one - Abs(py), px), fy = hn::CopySign(one - Abs(px), py);
      px = IfThenElse(lower, fx, px);
      py = IfThenElse(lower, fy, py);
    }
    const V share = Min(Max((distance - set(map.near)) * to_edge, zero), one);
    const V half = set(0.5 * map.directions);
    V fu, fv, fe;
    const V i = split(MulAdd(px + one, half, set(0.5)), side - 2, fu);
    const V j = split(MulAdd(py + one, half, set(0.5)), side - 2, fv);
    const V k = split(set(map.edges) * (even ? share : Sqrt(share)), map.edges - 1, fe);
    // Linear in the distance, not in its root: from edge k to k + 1 the square grows by 2 k + 1.
    if (!even) fe = fe * (k + k + fe) / MulAdd(set(2), k, one);
    // Places are exact in floating point, and multiplied there.
    const V number = MulAdd(j, set(double(row)), MulAdd(i, set(double(stride)), k));
    const VI place = hn::ConvertTo(di, IfThenElseZero(seen, number));
    const auto along = [&](int64_t offset) {
      const Pair pair = load_pair(map.depths, place + hn::Set(di, offset));
      return lerp(pair.first, pair.second, fe);
    };
    const V value = lerp(lerp(along(0), along(stride), fu), lerp(along(row), along(row + stride), fu), fv);
    hn::StoreU(IfThenElseZero(seen, value), d, depth + n);
  }
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(LookUp);

void look_up(const MapLookup& map, const double start[3], const double step[3], const double* t, int count,
             double* depth) {
  HWY_DYNAMIC_DISPATCH(LookUp)(map, start, step, t, count, depth);
}

}  // namespace airlight::fogshop
#endif
