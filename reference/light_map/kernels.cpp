#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/light_map/kernels.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <bit>

#include "reference/light_map/encoding.h"
#include "reference/light_map/kernels.h"
#include "reference/light_map/projection.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::light_map {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using H = hn::Rebind<float, D>;
using F = hn::ScalableTag<float>;
using I = hn::RebindToSigned<F>;
using VD = hn::Vec<D>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

// Converts metres around the light to texels and the share of the depth; outside the map the share is 0. Like fold()
// and place() of projection.cpp.
HWY_INLINE void on_octahedron(const PlaceRule& rule, VD& x, VD& y, VD& depth) {
  const D d;
  const VD zero = hn::Zero(d), one = hn::Set(d, 1.0), z = depth;
  const VD radius = Sqrt(MulAdd(x, x, MulAdd(y, y, z * z)));
  const VD scale = one / Max(Abs(x) + Abs(y) + Abs(z), hn::Set(d, 1e-300));
  const VD u = x * scale, v = y * scale;
  const auto behind = z < zero;
  const VD half = hn::Set(d, 0.5 * rule.size), per_reach = hn::Set(d, rule.per_reach);
  x = MulAdd(IfThenElse(behind, CopySign(one - Abs(v), u), u), per_reach, half);
  y = MulAdd(IfThenElse(behind, CopySign(one - Abs(u), v), v), per_reach, half);
  depth = (radius - hn::Set(d, rule.near)) * hn::Set(d, rule.per_range);
  if (!rule.whole_sphere) depth = IfThenElse(behind, zero, depth);
}

// World points to texels and shares of the depth, in double: a lamp may be far away from a small box.
void Project(const PlaceRule& rule, std::size_t n, const double* x, const double* y, const double* z,
             const Places& out) {
  const D d;
  const H h;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const VD px = hn::LoadU(d, x + i), py = hn::LoadU(d, y + i), pz = hn::LoadU(d, z + i);
    const auto local = [&](int k) HWY_ATTR {
      const double* m = rule.m + 3 * k;
      return MulAdd(hn::Set(d, m[2]), pz,
                    MulAdd(hn::Set(d, m[1]), py, MulAdd(hn::Set(d, m[0]), px, hn::Set(d, rule.b[k]))));
    };
    VD a = local(0), b = local(1), c = local(2);
    if (rule.octahedral) on_octahedron(rule, a, b, c);
    hn::StoreU(hn::DemoteTo(h, a), h, out.x + i);
    hn::StoreU(hn::DemoteTo(h, b), h, out.y + i);
    hn::StoreU(hn::DemoteTo(h, c), h, out.depth + i);
  }
}

void FindPlaces(const PlaceRule& rule, int floats, std::size_t n, const double* x, const double* y, const double* z,
                const Places& out) {
  Project(rule, n, x, y, z, out);
  const F f;
  const I integer;
  const VF zero = hn::Zero(f), one = hn::Set(f, 1.0f), half = hn::Set(f, 0.5f), size = hn::Set(f, float(rule.size));
  const VF least = hn::Set(f, float(-slack)), most = hn::Set(f, float(rule.size + slack));
  const VI row = hn::Set(integer, (rule.size + 2) * floats), texel = hn::Set(integer, floats);
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    VF px = hn::LoadU(f, out.x + i), py = hn::LoadU(f, out.y + i);
    const VF depth = hn::LoadU(f, out.depth + i);
    const auto inside = And(And(px >= least, px <= most), And(py >= least, py <= most));
    // Half a texel is the border, so that texel k of the padded map is centred at k.
    px = Min(Max(px, zero), size) + half;
    py = Min(Max(py, zero), size) + half;
    const VI left = hn::ConvertTo(integer, px), below = hn::ConvertTo(integer, py);
    hn::StoreU(below * row + left * texel, integer, out.texel + i);
    hn::StoreU(px - hn::ConvertTo(f, left), f, out.x + i);
    hn::StoreU(py - hn::ConvertTo(f, below), f, out.y + i);
    hn::StoreU(IfThenElseZero(inside, Min(Max(depth, zero), one)), f, out.depth + i);
  }
}

// The depths of points, prepared once for the four texels around each, and decoders of one of them.
struct Slices {
  VI slice;
  VF share;
  Slices(const Options& o, VF depth) {
    const F f;
    const I integer;
    const VF place = depth * hn::Set(f, float(o.slices));
    slice = Min(hn::ConvertTo(integer, place), hn::Set(integer, o.slices - 1));
    share = place - hn::ConvertTo(f, slice);
  }
  HWY_INLINE VF decode(const float* texels, VI texel) const {
    const F f;
    const VI at = texel + slice;
    const VF near = hn::GatherIndex(f, texels, at), far = hn::GatherIndex(f, texels + 1, at);
    return MulAdd(share, far - near, near);
  }
};

struct Adaptive {
  int nodes;
  VF depth;
  Adaptive(const Options& o, VF d) : nodes(o.nodes), depth(d) {}
  HWY_INLINE VF decode(const float* texels, VI texel) const {
    const F f;
    const I integer;
    const VI one = hn::Set(integer, 1), last = hn::Set(integer, nodes - 1);
    VI before = hn::Zero(integer);  // so many nodes are no deeper
    for (int step = int(std::bit_floor(unsigned(nodes))); step > 0; step /= 2) {
      const VI probe = before + hn::Set(integer, step - 1);
      const VF there = hn::GatherIndex(f, texels, texel + Min(probe, last));
      const auto passed = And(there <= depth, hn::RebindMask(f, probe < hn::Set(integer, nodes)));
      before = IfThenElse(hn::RebindMask(integer, passed), probe + one, before);
    }
    const VI a = texel + Max(before - one, hn::Zero(integer)), b = texel + Min(before, last);
    const VF near = hn::GatherIndex(f, texels, a), far = hn::GatherIndex(f, texels, b);
    const VF share = (depth - near) / Max(far - near, hn::Set(f, 1e-30f));
    const VF t = hn::GatherIndex(f, texels + nodes, a), behind = hn::GatherIndex(f, texels + nodes, b);
    const VF transmittance = MulAdd(Min(Max(share, hn::Zero(f)), hn::Set(f, 1.0f)), behind - t, t);
    return Neg(hn::Log(f, Max(transmittance, hn::Set(f, float(least_transmittance)))));
  }
};

struct Beer {
  VF depth;
  Beer(const Options&, VF d) : depth(d) {}
  HWY_INLINE VF decode(const float* texels, VI texel) const {
    const F f;
    const VF front = hn::GatherIndex(f, texels, texel), mean = hn::GatherIndex(f, texels + 1, texel),
             total = hn::GatherIndex(f, texels + 2, texel);
    const VF so_far = mean * Max(depth - front, hn::Zero(f));
    return IfThenElse(Abs(so_far) < Abs(total), so_far, total);
  }
};

HWY_INLINE VF blend(VF share, VF a, VF b) { return MulAdd(share, b - a, a); }

template <class Decoder>
void LookUpWith(const MapView& map, std::size_t n, const Places& places, float* out) {
  const F f;
  const I integer;
  const VI right = hn::Set(integer, floats_per_texel(map.options)), above = hn::Set(integer, map.row);
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VI texel = hn::LoadU(integer, places.texel + i);
    const VF x = hn::LoadU(f, places.x + i), y = hn::LoadU(f, places.y + i);
    const Decoder one(map.options, hn::LoadU(f, places.depth + i));
    const VF low = blend(x, one.decode(map.texels, texel), one.decode(map.texels, texel + right));
    const VF high = blend(x, one.decode(map.texels, texel + above), one.decode(map.texels, texel + above + right));
    const VF sum = blend(y, low, high);
    hn::StoreU(map.negative ? sum : Max(sum, hn::Zero(f)), f, out + i);
  }
}

// A series is linear in its coefficients: they are interpolated between texels, one after another.
void LookUpSeries(const MapView& map, std::size_t n, const Places& places, float* out) {
  const F f;
  const I integer;
  const float turn = 6.283185307179586f;
  const VF zero = hn::Zero(f), one = hn::Set(f, 1.0f);
  const VI right = hn::Set(integer, floats_per_texel(map.options)), above = hn::Set(integer, map.row);
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VI texel = hn::LoadU(integer, places.texel + i);
    const VF x = hn::LoadU(f, places.x + i), y = hn::LoadU(f, places.y + i), d = hn::LoadU(f, places.depth + i);
    const auto coefficient = [&](int c) HWY_ATTR {
      const float* const at = map.texels + c;
      const VF low = blend(x, hn::GatherIndex(f, at, texel), hn::GatherIndex(f, at, texel + right));
      const VI up = texel + above;
      return blend(y, low, blend(x, hn::GatherIndex(f, at, up), hn::GatherIndex(f, at, up + right)));
    };
    // Sine and cosine of turns by d, 2d, ...: each from the one before.
    const VF angle = hn::Set(f, turn) * d, s = hn::Sin(f, angle), c = hn::Cos(f, angle);
    VF sine = s, cosine = c;
    VF sum = hn::Set(f, 0.5f) * d * coefficient(0);
    for (int k = 1; 2 * k < map.options.coefficients; ++k) {
      const VF wave = MulAdd(coefficient(2 * k - 1), sine, coefficient(2 * k) * (one - cosine));
      sum = MulAdd(wave, hn::Set(f, 1 / (turn * float(k))), sum);
      const VF next = MulAdd(sine, c, cosine * s);
      cosine = MulSub(cosine, c, sine * s);
      sine = next;
    }
    hn::StoreU(map.negative ? sum : Max(sum, zero), f, out + i);
  }
}

void LookUp(const MapView& map, std::size_t n, const Places& places, float* out) {
  switch (map.options.encoding) {
    case Encoding::slices:
      return LookUpWith<Slices>(map, n, places, out);
    case Encoding::avsm:
      return LookUpWith<Adaptive>(map, n, places, out);
    case Encoding::fourier:
      return LookUpSeries(map, n, places, out);
    case Encoding::beer:
      return LookUpWith<Beer>(map, n, places, out);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight::light_map
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::light_map {

PlaceRule rule_of(const Projection& p) {
  PlaceRule rule{};
  rule.octahedral = p.kind == Projection::Kind::octahedral;
  rule.whole_sphere = p.whole_sphere();
  rule.size = p.size;
  rule.per_reach = 0.5 * p.size / p.reach;
  rule.near = p.depth.lo;
  rule.per_range = 1 / p.depth.length();
  const double factors[3] = {p.size / p.across[0].length(), p.size / p.across[1].length(), 1 / p.depth.length()};
  const double begins[3] = {p.across[0].lo, p.across[1].lo, p.depth.lo};
  for (int k = 0; k < 3; ++k) {
    const double factor = rule.octahedral ? 1 : factors[k];
    for (int i = 0; i < 3; ++i) rule.m[3 * k + i] = factor * p.axes(k, i);
    rule.b[k] = rule.octahedral ? -p.axes.row(k).dot(p.light) : -factor * begins[k];
  }
  return rule;
}

HWY_EXPORT(FindPlaces);
void find_places(const PlaceRule& rule, int floats_per_texel, std::size_t n, const double* x, const double* y,
                 const double* z, const Places& places) {
  HWY_DYNAMIC_DISPATCH(FindPlaces)(rule, floats_per_texel, n, x, y, z, places);
}

HWY_EXPORT(LookUp);
void look_up(const MapView& map, std::size_t n, const Places& places, float* optical_depth) {
  HWY_DYNAMIC_DISPATCH(LookUp)(map, n, places, optical_depth);
}

}  // namespace airlight::light_map
#endif
