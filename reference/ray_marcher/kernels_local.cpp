#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/ray_marcher/kernels_local.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/highway.h>

#include "reference/ray_marcher/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::ray_marcher {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using H = hn::Rebind<float, D>;  // as many floats as there are doubles
using F = hn::ScalableTag<float>;
using VF = hn::Vec<F>;

void ToLocal(const Frame& frame, std::size_t n, const double* x, const double* y, const double* z, float* lx, float* ly,
             float* lz) {
  const D d;
  const H h;
  float* const out[3] = {lx, ly, lz};
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const auto px = hn::LoadU(d, x + i), py = hn::LoadU(d, y + i), pz = hn::LoadU(d, z + i);
    for (int k = 0; k < 3; ++k) {
      const double* m = frame.m + 3 * k;
      const auto sum = MulAdd(hn::Set(d, m[2]), pz,
                              MulAdd(hn::Set(d, m[1]), py, MulAdd(hn::Set(d, m[0]), px, hn::Set(d, frame.b[k]))));
      hn::StoreU(hn::DemoteTo(h, sum), h, out[k] + i);
    }
  }
}

void RotateToLocal(const Frame& frame, std::size_t n, const float* x, const float* y, const float* z, float* lx,
                   float* ly, float* lz) {
  const F f;
  float* const out[3] = {lx, ly, lz};
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VF vx = hn::LoadU(f, x + i), vy = hn::LoadU(f, y + i), vz = hn::LoadU(f, z + i);
    for (int k = 0; k < 3; ++k) {
      const double* m = frame.m + 3 * k;
      hn::StoreU(MulAdd(hn::Set(f, float(m[2])), vz, MulAdd(hn::Set(f, float(m[1])), vy, hn::Set(f, float(m[0])) * vx)),
                 f, out[k] + i);
    }
  }
}

// A direction's reciprocal, finite where the component is 0.
HWY_INLINE VF reciprocal(VF v) {
  const F f;
  const VF tiny = hn::Set(f, 1e-30f);
  return hn::Set(f, 1.0f) / IfThenElse(Abs(v) < tiny, tiny, v);
}

HWY_INLINE void clip_slab(VF o, VF d, VF lo, VF hi, VF& t0, VF& t1) {
  const VF r = reciprocal(d);
  const VF a = (lo - o) * r, b = (hi - o) * r;
  t0 = Max(t0, Min(a, b));
  t1 = Min(t1, Max(a, b));
}

void ClipBox(const float* lo, const float* hi, int axes, std::size_t n, const LocalRays& rays) {
  const F f;
  const float* const o[3] = {rays.ox, rays.oy, rays.oz};
  const float* const d[3] = {rays.dx, rays.dy, rays.dz};
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    VF t0 = hn::LoadU(f, rays.t0 + i), t1 = hn::LoadU(f, rays.t1 + i);
    for (int k = 0; k < axes; ++k)  // 1 or 3; NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult)
      clip_slab(hn::LoadU(f, o[k] + i), hn::LoadU(f, d[k] + i), hn::Set(f, lo[k]), hn::Set(f, hi[k]), t0, t1);
    hn::StoreU(t0, f, rays.t0 + i);
    hn::StoreU(t1, f, rays.t1 + i);
  }
}

// Unit sphere: from the point of closest approach, which loses no digits for origins far away.
void ClipSphere(std::size_t n, const LocalRays& rays) {
  const F f;
  const VF one = hn::Set(f, 1.0f);
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VF ox = hn::LoadU(f, rays.ox + i), oy = hn::LoadU(f, rays.oy + i), oz = hn::LoadU(f, rays.oz + i);
    const VF dx = hn::LoadU(f, rays.dx + i), dy = hn::LoadU(f, rays.dy + i), dz = hn::LoadU(f, rays.dz + i);
    const VF dd = MulAdd(dx, dx, MulAdd(dy, dy, dz * dz));
    const VF nearest = Neg(MulAdd(ox, dx, MulAdd(oy, dy, oz * dz)) / dd);
    const VF qx = MulAdd(nearest, dx, ox), qy = MulAdd(nearest, dy, oy), qz = MulAdd(nearest, dz, oz);
    const VF inside = one - MulAdd(qx, qx, MulAdd(qy, qy, qz * qz));
    const VF half = Sqrt(Max(inside, hn::Zero(f)) / dd);
    hn::StoreU(Max(hn::LoadU(f, rays.t0 + i), nearest - half), f, rays.t0 + i);
    hn::StoreU(Min(hn::LoadU(f, rays.t1 + i), nearest + half), f, rays.t1 + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight::ray_marcher
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::ray_marcher {

HWY_EXPORT(ToLocal);
void to_local(const Frame& frame, std::size_t n, const double* x, const double* y, const double* z, float* lx,
              float* ly, float* lz) {
  HWY_DYNAMIC_DISPATCH(ToLocal)(frame, n, x, y, z, lx, ly, lz);
}

HWY_EXPORT(RotateToLocal);
void rotate_to_local(const Frame& frame, std::size_t n, const float* x, const float* y, const float* z, float* lx,
                     float* ly, float* lz) {
  HWY_DYNAMIC_DISPATCH(RotateToLocal)(frame, n, x, y, z, lx, ly, lz);
}

HWY_EXPORT(ClipBox);
HWY_EXPORT(ClipSphere);
void clip_rays(const float lo[3], const float hi[3], std::size_t n, const LocalRays& rays) {
  HWY_DYNAMIC_DISPATCH(ClipBox)(lo, hi, 3, n, rays);
}
void clip_rays(const LocalShape& shape, std::size_t n, const LocalRays& rays) {
  const float lo[3] = {-shape.half[0], -shape.half[1], -shape.half[2]};
  if (shape.kind == LocalShape::box) HWY_DYNAMIC_DISPATCH(ClipBox)(lo, shape.half, 3, n, rays);
  if (shape.kind == LocalShape::slab) HWY_DYNAMIC_DISPATCH(ClipBox)(lo, shape.half, 1, n, rays);
  if (shape.kind == LocalShape::sphere) HWY_DYNAMIC_DISPATCH(ClipSphere)(n, rays);
}

}  // namespace airlight::ray_marcher
#endif
