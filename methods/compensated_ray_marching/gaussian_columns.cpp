#include "methods/compensated_ray_marching/gaussian_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/compensated_ray_marching/gaussian_columns.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/math/erf-inl.h"

#ifndef AIRLIGHT_GAUSSIAN_COLUMNS_ONCE
#define AIRLIGHT_GAUSSIAN_COLUMNS_ONCE
namespace airlight::compensated_ray_marching {

constexpr float nothing_beyond = 4.5f;  // widths: 2e-9 of the amplitude, 2e-10 of the integral

// Gaussians and points across the direction and along it, from the middle of the points.
struct Nearby {
  std::vector<float> u, v, t, inverse_width, reach, full;
};
struct Starts {
  std::size_t count = 0;
  std::vector<float> u, v, t;  // with room for whole vectors, whose last lanes repeat the last point
};

}  // namespace airlight::compensated_ray_marching
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight::compensated_ray_marching::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using VF = hn::Vec<F>;
constexpr F f;

// Chebyshev interpolation of erf(x)/x in x^2 up to 3.9, beyond which 1 - erf is below 4e-8. Error 1.5e-7, rounding to floats included.
struct SingleErf {
  static constexpr float cut = 3.9f, scale = 2 / (3.9f * 3.9f);
  static constexpr float coefficient[] = {0.36258397f,    -0.181011014f,  0.134691328f,   -0.109535249f,
                                          0.0906657511f,  -0.0737695619f, 0.0579325868f,  -0.0429527896f,
                                          0.0290557349f,  -0.0190962107f, 0.013700547f,   -0.00774433667f,
                                          0.00181648643f, -0.0010229698f, 0.00194829136f, -0.000852326142f};
};
HWY_INLINE VF error_function(VF x) { return airlight::HWY_NAMESPACE::ErfBy<SingleErf>(f, x); }

void AddColumns(const Nearby& near, float cutoff, const Starts& starts, float* columns) {
  const std::size_t lanes = hn::Lanes(f), end = starts.count;
  const float widest = std::min(cutoff, nothing_beyond), end2 = widest * widest;
  const bool cut = cutoff <= nothing_beyond;
  for (std::size_t i = 0; i < end; i += lanes) {
    const VF u = hn::LoadU(f, starts.u.data() + i), v = hn::LoadU(f, starts.v.data() + i);
    const VF t = hn::LoadU(f, starts.t.data() + i);
    const auto least = [&](VF x) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(f, x)); };
    const auto most = [&](VF x) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(f, x)); };
    const float u0 = least(u), u1 = most(u), v0 = least(v), v1 = most(v), t0 = least(t);
    VF sum = hn::Zero(f);
    for (std::size_t g = 0; g < near.u.size(); ++g) {
      const float reach = near.reach[g], gu = near.u[g], gv = near.v[g];
      if (gu + reach < u0 || gu - reach > u1 || gv + reach < v0 || gv - reach > v1 || near.t[g] + reach < t0) continue;
      const VF scale = hn::Set(f, near.inverse_width[g]);
      const VF du = scale * (hn::Set(f, gu) - u), dv = scale * (hn::Set(f, gv) - v);
      const VF ahead = scale * (hn::Set(f, near.t[g]) - t);
      const VF aside = MulAdd(du, du, dv * dv);
      VF beyond = hn::Set(f, 1.0f), before = ahead;
      const auto met = And(aside <= hn::Set(f, end2), ahead >= hn::Set(f, -nothing_beyond));
      if (cut) {
        const VF half = Sqrt(Max(hn::Set(f, end2) - aside, hn::Zero(f)));
        beyond = error_function(half);
        before = Max(Neg(half), Min(ahead, half));
      }
      const VF share = hn::Exp(f, Neg(aside)) * (beyond + error_function(before));
      // Decided for each ray alone, so that the bits do not depend on how many rays are processed together.
      sum = IfThenElse(met, MulAdd(hn::Set(f, 0.5f * near.full[g]), share, sum), sum);
    }
    hn::BlendedStore(sum, hn::FirstN(f, std::min(lanes, end - i)), f, columns + i);
  }
}

}  // namespace airlight::compensated_ray_marching::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::compensated_ray_marching {

HWY_EXPORT(AddColumns);

constexpr std::size_t most_lanes = 16;

bool GaussianColumns::knows(const scene::GaussianSum& sum) {
  return sum.constant == 0 && std::all_of(sum.gaussians.begin(), sum.gaussians.end(),
                                          [](const scene::Gaussian& g) { return g.amplitude >= 0; });
}

GaussianColumns::GaussianColumns(const scene::GaussianSum& sum) : cutoff_(float(sum.cutoff)) {
  for (const scene::Gaussian& g : sum.gaussians) {
    x_.push_back(g.center[0]), y_.push_back(g.center[1]), z_.push_back(g.center[2]);
    width_.push_back(g.width);
    reach_.push_back(g.width * std::min(sum.cutoff, double(nothing_beyond)));
    full_.push_back(std::sqrt(pi) * g.amplitude * g.width);
  }
}

void GaussianColumns::from(const std::vector<Point3>& points, const Vec3& direction, float* columns) const {
  const Vec3 across = direction.unitOrthogonal(), other = direction.cross(across);
  Box box;
  for (const Point3& p : points) box = unite(box, {p, p});
  const Point3 middle = box.center();
  Starts starts{points.size(), {}, {}, {}};
  double radius = 0, first = infinity;
  for (std::size_t i = 0; i < points.size() + most_lanes; ++i) {
    const Vec3 p = points[std::min(i, points.size() - 1)] - middle;
    const double u = p.dot(across), v = p.dot(other), t = p.dot(direction);
    starts.u.push_back(float(u)), starts.v.push_back(float(v)), starts.t.push_back(float(t));
    radius = std::max(radius, u * u + v * v);
    first = std::min(first, t);
  }
  radius = std::sqrt(radius);
  Nearby near;
  for (std::size_t g = 0; g < x_.size(); ++g) {
    const double x = x_[g] - middle[0], y = y_[g] - middle[1], z = z_[g] - middle[2];
    const double u = x * across[0] + y * across[1] + z * across[2], v = x * other[0] + y * other[1] + z * other[2];
    const double t = x * direction[0] + y * direction[1] + z * direction[2], limit = reach_[g] + radius;
    if (u * u + v * v > limit * limit || t + reach_[g] < first) continue;
    near.u.push_back(float(u)), near.v.push_back(float(v)), near.t.push_back(float(t));
    near.inverse_width.push_back(float(1 / width_[g]));
    near.reach.push_back(float(reach_[g]) * 1.0001f);
    near.full.push_back(float(full_[g]));
  }
  HWY_DYNAMIC_DISPATCH(AddColumns)(near, cutoff_, starts, columns);
}

}  // namespace airlight::compensated_ray_marching
#endif
