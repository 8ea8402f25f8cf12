#include "methods/fogshop/kernels.h"

#include <Eigen/Geometry>
#include <cmath>
#include <iterator>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/fogshop/kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "methods/fogshop/arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::fogshop::HWY_NAMESPACE {

constexpr hn::Rebind<int, D> integers;

template <Erf kind>
double ErrorFunction(double x) {
  return hn::GetLane(Erf_<kind>(d, set(x)));
}

template <Erf kind>
void Cross(const GaussianArrays& g, const Line& line, Crossings& out) {
  const Vectors direction{set(line.direction.x()), set(line.direction.y()), set(line.direction.z())};
  const V ox = set(line.origin.x()), oy = set(line.origin.y()), oz = set(line.origin.z());
  const V length = set(line.length), zero = hn::Zero(d);
  const auto iota = hn::Iota(d, 0.0);
  std::size_t n = 0;
  for (std::size_t i = 0; i < g.x.size(); i += hn::Lanes(d)) {
    const Vectors q{load(g.x, i) - ox, load(g.y, i) - oy, load(g.z, i) - oz};
    const auto [m, pp] = project(q, direction);
    const V chord_squared = load(g.radius_squared, i) - pp;
    if (hn::AllFalse(d, chord_squared >= zero)) continue;
    const V chord = Sqrt(Max(chord_squared, zero));
    const auto met = And(chord_squared >= zero, And(m + chord >= zero, m - chord <= length));
    if (hn::AllFalse(d, met)) continue;
    // Whole vectors are stored, the next ones over their rest: a compressing store is many times slower on some
    // processors.
    const auto keep = [&](V v, std::vector<double>& to) { hn::StoreU(compress(v, met), d, to.data() + n); };
    const V a = load(g.a, i);
    keep(m, out.middle);
    keep(a, out.a);
    keep(chord, out.chord);
    keep(load(g.x, i), out.x);
    keep(load(g.y, i), out.y);
    keep(load(g.z, i), out.z);
    keep(load(g.half_depth, i), out.half_depth);
    keep(peak_exponent(a, pp), out.base);
    const auto keep_number = [&](V v, std::vector<int>& to) {
      hn::StoreU(hn::DemoteTo(integers, compress(v, met)), integers, to.data() + n);
    };
    keep_number(iota + set(double(i)), out.place);
    keep_number(hn::PromoteTo(d, hn::LoadU(integers, g.index.data() + i)), out.index);
    n += hn::CountTrue(d, met);
  }
  for (std::vector<int>* v : {&out.place, &out.index}) hn::StoreU(hn::Zero(integers), integers, v->data() + n);
  // Only now, with all lanes in use, what is costly.
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    hn::StoreU(load(out.half_depth, i) * exp_of(load(out.base, i)), d, out.depth.data() + i);
    hn::StoreU(Erf_<kind>(d, load(out.a, i) * load(out.middle, i)), d, out.base.data() + i);
  }
  out.count = int(n);
}

template <Erf kind>
double TotalDepth(const Crossings& c, double length) {
  V sum = hn::Zero(d);
  const V end = set(length);
  for (std::size_t i = 0; i < std::size_t(c.count); i += hn::Lanes(d)) {
    const V share = share_up_to<kind>(end, load(c.a, i), load(c.middle, i), load(c.base, i));
    const V depth = load(c.depth, i) * share;
    sum = sum + IfThenElseZero(hn::FirstN(d, c.count - i), depth);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

template <Erf kind>
double WholeDepths(Crossings& c, double length) {
  V sum = hn::Zero(d);
  const V end = set(length), zero = hn::Zero(d);
  for (std::size_t i = 0; i < std::size_t(c.count); i += hn::Lanes(d)) {
    const V m = load(c.middle, i), scale = load(c.depth, i), base = load(c.base, i);
    const V whole = scale * share_up_to<kind>(end, load(c.a, i), m, base);
    // At the middle itself the first error function is that of 0.
    const V within = IfThenElse(m <= end, scale * base, whole);
    hn::StoreU(whole, d, c.whole.data() + i);
    hn::StoreU(Max(within, zero), d, c.to_nearest.data() + i);
    sum = sum + IfThenElseZero(hn::FirstN(d, c.count - i), whole);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

template <Erf kind>
void DepthsAt(const Crossings& c, const double* t, int count, double* depth) {
  for (int k = 0; k < count; k += int(hn::Lanes(d))) {
    const V end = hn::LoadU(d, t + k);
    V sum = hn::Zero(d);
    for (int i = 0; i < c.count; ++i) {
      const V share = share_up_to<kind>(end, set(c.a[i]), set(c.middle[i]), set(c.base[i]));
      sum = MulAdd(set(c.depth[i]), share, sum);
    }
    hn::StoreU(sum, d, depth + k);
  }
}

template <Erf kind>
void ScatteringDepthsAt(const Crossings& c, const GaussianArrays& g, const double* t, int count, double* depth,
                        double* const scattering[3]) {
  for (int k = 0; k < count; k += int(hn::Lanes(d))) {
    const V end = hn::LoadU(d, t + k);
    V sum = hn::Zero(d), red = sum, green = sum, blue = sum;
    for (int i = 0; i < c.count; ++i) {
      const V share = share_up_to<kind>(end, set(c.a[i]), set(c.middle[i]), set(c.base[i]));
      const V part = set(c.depth[i]) * share;
      const int place = c.place[i];
      sum = sum + part;
      red = MulAdd(set(g.colour[0][place]), part, red);
      green = MulAdd(set(g.colour[1][place]), part, green);
      blue = MulAdd(set(g.colour[2][place]), part, blue);
    }
    hn::StoreU(sum, d, depth + k);
    hn::StoreU(red, d, scattering[0] + k);
    hn::StoreU(green, d, scattering[1] + k);
    hn::StoreU(blue, d, scattering[2] + k);
  }
}

template <Erf kind>
void DepthsFromPoint(const GaussianArrays& g, const Point3& from, const Line& ray, const double* t, int count,
                     double* depth) {
  const Vec3 offset = ray.origin - from;
  for (int k = 0; k < count; k += int(hn::Lanes(d))) {
    const V tk = hn::LoadU(d, t + k);
    const Vectors to{MulAdd(tk, set(ray.direction.x()), set(offset.x())),
                     MulAdd(tk, set(ray.direction.y()), set(offset.y())),
                     MulAdd(tk, set(ray.direction.z()), set(offset.z()))};
    const V length = Sqrt(dot(to, to)), inverse = set(1) / Max(length, set(1e-300));
    const Vectors direction{to.x * inverse, to.y * inverse, to.z * inverse};
    V sum = hn::Zero(d);
    for (int i = 0; i < g.count; ++i) {
      const V a = set(g.a[i]);
      const auto [m, pp] = project({set(g.x[i] - from.x()), set(g.y[i] - from.y()), set(g.z[i] - from.z())}, direction);
      const V scale = set(g.half_depth[i]) * exp_of(peak_exponent(a, pp));
      sum = MulAdd(scale, share_up_to<kind>(length, a, m, Erf_<kind>(d, a * m)), sum);
    }
    hn::StoreU(sum, d, depth + k);
  }
}

// The slab around the triangle's plane, cut by the three half spaces outside its edges. Each plane is (normal, offset).
void NearPrism(const GaussianArrays& g, const double planes[4][4], std::vector<int>& places) {
  places.clear();
  const auto distance = [&](std::size_t i, const double* p) {
    return MulAdd(load(g.x, i), set(p[0]), MulAdd(load(g.y, i), set(p[1]), MulAdd(load(g.z, i), set(p[2]), set(p[3]))));
  };
  for (std::size_t i = 0; i < g.x.size(); i += hn::Lanes(d)) {
    V farthest = Abs(distance(i, planes[0]));
    for (int e = 1; e < 4; ++e) farthest = Max(farthest, distance(i, planes[e]));
    const auto near = Max(farthest, hn::Zero(d)) * Max(farthest, hn::Zero(d)) <= load(g.radius_squared, i);
    if (hn::AllFalse(d, near)) continue;
    alignas(64) double place[GaussianArrays::padding];
    hn::Store(compress(hn::Iota(d, double(i)), near), d, place);
    const std::size_t found = hn::CountTrue(d, near);
    for (std::size_t k = 0; k < found; ++k) places.push_back(int(place[k]));
  }
}

// The approximation of erf is chosen here, outside the loops.
void CrossAny(const GaussianArrays& g, const Line& line, Erf erf, Crossings& out) {
  if (erf == Erf::precise) return Cross<Erf::precise>(g, line, out);
  if (erf == Erf::erf10) return Cross<Erf::erf10>(g, line, out);
  return Cross<Erf::paper>(g, line, out);
}

double TotalDepthAny(const Crossings& c, double length, Erf erf) {
  if (erf == Erf::precise) return TotalDepth<Erf::precise>(c, length);
  if (erf == Erf::erf10) return TotalDepth<Erf::erf10>(c, length);
  return TotalDepth<Erf::paper>(c, length);
}

double WholeDepthsAny(Crossings& c, double length, Erf erf) {
  if (erf == Erf::precise) return WholeDepths<Erf::precise>(c, length);
  if (erf == Erf::erf10) return WholeDepths<Erf::erf10>(c, length);
  return WholeDepths<Erf::paper>(c, length);
}

void DepthsAtAny(const Crossings& c, const double* t, int count, double* depth, Erf erf) {
  if (erf == Erf::precise) return DepthsAt<Erf::precise>(c, t, count, depth);
  if (erf == Erf::erf10) return DepthsAt<Erf::erf10>(c, t, count, depth);
  return DepthsAt<Erf::paper>(c, t, count, depth);
}

void ScatteringDepthsAtAny(const Crossings& c, const GaussianArrays& g, const double* t, int count, double* depth,
                           double* const scattering[3], Erf erf) {
  if (erf == Erf::precise) return ScatteringDepthsAt<Erf::precise>(c, g, t, count, depth, scattering);
  if (erf == Erf::erf10) return ScatteringDepthsAt<Erf::erf10>(c, g, t, count, depth, scattering);
  return ScatteringDepthsAt<Erf::paper>(c, g, t, count, depth, scattering);
}

void DepthsFromPointAny(const GaussianArrays& g, const Point3& from, const Line& ray, const double* t, int count,
                        double* depth, Erf erf) {
  if (erf == Erf::precise) return DepthsFromPoint<Erf::precise>(g, from, ray, t, count, depth);
  if (erf == Erf::erf10) return DepthsFromPoint<Erf::erf10>(g, from, ray, t, count, depth);
  return DepthsFromPoint<Erf::paper>(g, from, ray, t, count, depth);
}

template <Erf kind>
void FillTable(ErfTable& table) {
  using P = ErfPolynomial<kind>;
  table = {P::cut, P::scale, {std::begin(P::coefficient), std::end(P::coefficient)}};
}

void ErfTableAny(Erf erf, ErfTable& table) {
  if (erf == Erf::precise) return FillTable<Erf::precise>(table);
  if (erf == Erf::erf10) return FillTable<Erf::erf10>(table);
  return FillTable<Erf::paper>(table);
}

double ErrorFunctionAny(double x, Erf erf) {
  if (erf == Erf::precise) return ErrorFunction<Erf::precise>(x);
  if (erf == Erf::erf10) return ErrorFunction<Erf::erf10>(x);
  return ErrorFunction<Erf::paper>(x);
}

}  // namespace airlight::fogshop::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::fogshop {

HWY_EXPORT(CrossAny);
HWY_EXPORT(TotalDepthAny);
HWY_EXPORT(WholeDepthsAny);
HWY_EXPORT(DepthsAtAny);
HWY_EXPORT(ScatteringDepthsAtAny);
HWY_EXPORT(DepthsFromPointAny);
HWY_EXPORT(ErrorFunctionAny);
HWY_EXPORT(NearPrism);
HWY_EXPORT(ErfTableAny);

ErfTable erf_table(Erf erf) {
  ErfTable table;
  HWY_DYNAMIC_DISPATCH(ErfTableAny)(erf, table);
  return table;
}

double error_function(Erf erf, double x) { return HWY_DYNAMIC_DISPATCH(ErrorFunctionAny)(x, erf); }

Line line_between(const Point3& from, const Point3& to) {
  const Vec3 offset = to - from;
  const double length = offset.norm();
  return {from, length > 0 ? Vec3(offset / length) : Vec3(Vec3::UnitZ()), length};
}

void Crossings::reserve(int gaussians) {
  const std::size_t room = std::size_t(gaussians) + GaussianArrays::padding;
  if (middle.size() >= room) return;
  for (std::vector<double>* v : {&middle, &a, &depth, &base, &chord, &whole, &to_nearest, &x, &y, &z, &half_depth})
    v->assign(room, 0.0);
  place.assign(room, 0);
  index.assign(room, 0);
}

void cross(const GaussianArrays& gaussians, const Line& line, Erf erf, Crossings& out) {
  out.reserve(int(gaussians.x.size()));
  HWY_DYNAMIC_DISPATCH(CrossAny)(gaussians, line, erf, out);
}

double total_depth(const Crossings& crossings, double length, Erf erf) {
  return HWY_DYNAMIC_DISPATCH(TotalDepthAny)(crossings, length, erf);
}

double whole_depths(Crossings& crossings, double length, Erf erf) {
  return HWY_DYNAMIC_DISPATCH(WholeDepthsAny)(crossings, length, erf);
}

void depths_at(const Crossings& crossings, const double* t, int count, double* depth, Erf erf) {
  HWY_DYNAMIC_DISPATCH(DepthsAtAny)(crossings, t, count, depth, erf);
}

void scattering_depths_at(const Crossings& crossings, const GaussianArrays& gaussians, const double* t, int count,
                          double* depth, double* const scattering[3], Erf erf) {
  HWY_DYNAMIC_DISPATCH(ScatteringDepthsAtAny)(crossings, gaussians, t, count, depth, scattering, erf);
}

void depths_from_point(const GaussianArrays& gaussians, const Point3& from, const Line& ray, const double* t, int count,
                       double* depth, Erf erf) {
  HWY_DYNAMIC_DISPATCH(DepthsFromPointAny)(gaussians, from, ray, t, count, depth, erf);
}

void near_triangle(const GaussianArrays& gaussians, const Point3& corner, const Line& ray, double lo, double hi,
                   std::vector<int>& places) {
  const Point3 start = ray.origin + lo * ray.direction, end = ray.origin + hi * ray.direction;
  const Vec3 normal = ray.direction.cross(corner - start);
  const double h = normal.norm();
  double planes[4][4] = {};  // zero planes let everything pass: a flat triangle is not culled
  if (h > 1e-9 * ((corner - start).norm() + (corner - end).norm())) {
    const Vec3 up = normal / h;
    const auto put = [&](double* plane, const Vec3& n, const Point3& through) {
      plane[0] = n.x(), plane[1] = n.y(), plane[2] = n.z(), plane[3] = -n.dot(through);
    };
    put(planes[0], up, start);
    const Point3 corners[3] = {start, end, corner};
    for (int e = 0; e < 3; ++e) {
      const Vec3 edge = corners[(e + 1) % 3] - corners[e];
      const double length = edge.norm();
      if (length > 0) put(planes[e + 1], edge.cross(up) / length, corners[e]);
    }
  }
  HWY_DYNAMIC_DISPATCH(NearPrism)(gaussians, planes, places);
}

}  // namespace airlight::fogshop
#endif
