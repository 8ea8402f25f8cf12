#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/ray_marcher/kernels_grid.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/highway.h>

#include <cstdint>

#include "reference/ray_marcher/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::ray_marcher {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

// The field as lanes need it.
struct View {
  const float* pairs;
  const float* free_distance;
  VI row, slice;  // strides of the samples
  VI brick_row, brick_slice;
  std::ptrdiff_t next_row;
};

View view_of(const GridField& field) {
  const I i;
  return {field.samples->pairs.data(),      field.samples->free_distance.data(),
          hn::Set(i, field.size[0]),        hn::Set(i, field.size[0] * field.size[1]),
          hn::Set(i, field.bricks[0]),      hn::Set(i, field.bricks[0] * field.bricks[1]),
          2 * std::ptrdiff_t(field.size[0])};
}

// 128 bits from each of base + 2 * at[0], at[4], at[8], ..: one block per four lanes.
HWY_INLINE VF load_blocks(const float* base, const std::uint32_t* at) {
  const hn::CappedTag<float, 4> block;
  const auto load = [&](int lane) HWY_ATTR { return hn::LoadU(block, base + 2 * std::size_t(at[lane])); };
#if HWY_MAX_BYTES == 64
  const hn::Half<F> half;
  return hn::Combine(F(), hn::Combine(half, load(12), load(8)), hn::Combine(half, load(4), load(0)));
#elif HWY_MAX_BYTES == 32
  return hn::Combine(F(), load(4), load(0));
#else
  return load(0);
#endif
}

// Values at x and x + 1 of one row of samples, each linear in z. Plain loads and a 4x4 transposition in each block of
// four lanes: twice as fast as gathering.
HWY_INLINE void row_ends(const float* base, const std::uint32_t* at, VF fz, VF& left, VF& right) {
  const F f;
  const hn::RepartitionToWide<hn::RebindToUnsigned<F>> wide;
  const VF v0 = load_blocks(base, at), v1 = load_blocks(base, at + 1), v2 = load_blocks(base, at + 2),
           v3 = load_blocks(base, at + 3);
  const auto a = hn::BitCast(wide, hn::InterleaveLower(f, v0, v1)),
             b = hn::BitCast(wide, hn::InterleaveUpper(f, v0, v1));
  const auto c = hn::BitCast(wide, hn::InterleaveLower(f, v2, v3)),
             d = hn::BitCast(wide, hn::InterleaveUpper(f, v2, v3));
  const VF near_left = hn::BitCast(f, hn::InterleaveLower(wide, a, c)),
           far_left = hn::BitCast(f, hn::InterleaveUpper(wide, a, c));
  const VF near_right = hn::BitCast(f, hn::InterleaveLower(wide, b, d)),
           far_right = hn::BitCast(f, hn::InterleaveUpper(wide, b, d));
  left = MulAdd(fz, far_left - near_left, near_left);
  right = MulAdd(fz, far_right - near_right, near_right);
}

HWY_INLINE VF trilinear(const View& view, VF x, VF y, VF z) {
  const F f;
  const I i;
  // Local coordinates are positive, so that truncation is the floor.
  const VI ix = hn::ConvertTo(i, x), iy = hn::ConvertTo(i, y), iz = hn::ConvertTo(i, z);
  const VF fx = x - hn::ConvertTo(f, ix), fy = y - hn::ConvertTo(f, iy), fz = z - hn::ConvertTo(f, iz);
  const hn::RebindToUnsigned<F> u;
  HWY_ALIGN std::uint32_t at[HWY_MAX_BYTES / sizeof(std::uint32_t)];
  hn::Store(hn::BitCast(u, ix + (iy * view.row + iz * view.slice)), u, at);
  VF a, b, c, d;
  row_ends(view.pairs, at, fz, a, b);
  row_ends(view.pairs + view.next_row, at, fz, c, d);
  const VF left = MulAdd(fy, c - a, a), right = MulAdd(fy, d - b, b);
  return MulAdd(fx, right - left, left);
}

HWY_INLINE VF free_distance(const View& view, VF x, VF y, VF z) {
  const F f;
  const I i;
  constexpr int shift = GridField::brick_shift;
  const VI bx = hn::ShiftRight<shift>(hn::ConvertTo(i, x)), by = hn::ShiftRight<shift>(hn::ConvertTo(i, y)),
           bz = hn::ShiftRight<shift>(hn::ConvertTo(i, z));
  const VI at = bx + (by * view.brick_row + bz * view.brick_slice);
  return hn::GatherIndex(f, view.free_distance, at);
}

void GridDensity(const GridField& field, std::size_t n, const float* x, const float* y, const float* z,
                 float* density) {
  const F f;
  const View view = view_of(field);
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const auto used = hn::FirstN(f, n - i);
    const auto load = [&](const float* p) HWY_ATTR { return IfThenElseZero(used, hn::LoadU(f, p + i)); };
    hn::StoreU(trilinear(view, load(x), load(y), load(z)), f, density + i);
  }
}

long long GridColumns(const GridField& field, const StepRule& rule, bool skip, std::size_t n, const LocalRays& rays,
                      float* column) {
  const F f;
  const View view = view_of(field);
  const VF zero = hn::Zero(f), half = hn::Set(f, 0.5f), one = hn::Set(f, 1.0f);
  long long evaluations = 0;
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const VF t0 = hn::LoadU(f, rays.t0 + i);
    const VF length = Max(zero, hn::LoadU(f, rays.t1 + i) - t0);
    VF steps = hn::Set(f, float(rule.count));
    if (rule.length > 0) steps = Min(Max(one, hn::Ceil(length / hn::Set(f, rule.length))), hn::Set(f, 1048576.0f));
    const VF h = length / steps;
    auto running = And(length > zero, hn::FirstN(f, n - i));
    const auto delta = [&](const float* d) HWY_ATTR { return h * hn::LoadU(f, d + i); };
    const VF dx = delta(rays.dx), dy = delta(rays.dy), dz = delta(rays.dz);
    // Midpoint of the first step. Lanes that do not run stay there, and it must be within the grid.
    const VF start = MulAdd(half, h, t0);
    const auto first = [&](const float* o, const float* d) HWY_ATTR {
      return IfThenElseZero(running, MulAdd(start, hn::LoadU(f, d + i), hn::LoadU(f, o + i)));
    };
    const VF ox = first(rays.ox, rays.dx), oy = first(rays.oy, rays.dy), oz = first(rays.oz, rays.dz);
    // Steps per cell of the largest component: how many steps a free distance is worth.
    const VF pace = one / Max(Abs(dx), Max(Abs(dy), Abs(dz)));
    VF step = zero, sum = zero;
    while (!hn::AllFalse(f, running)) {
      const VF at = IfThenElseZero(running, step);
      const VF x = MulAdd(at, dx, ox), y = MulAdd(at, dy, oy), z = MulAdd(at, dz, oz);
      const VF value = IfThenElseZero(running, trilinear(view, x, y, z));
      sum = sum + value;
      evaluations += hn::CountTrue(f, running);
      step = step + one;
      // The map is asked only when all lanes have come to where there is nothing: within the smoke it costs nothing.
      if (skip && hn::AllTrue(f, value == zero)) {
        const VF free = free_distance(view, x, y, z);
        step = step + Floor(Max(free, zero) * pace);
      }
      running = And(running, step < steps);
    }
    hn::StoreU(MulAdd(sum, h, hn::LoadU(f, column + i)), f, column + i);
  }
  return evaluations;
}

}  // namespace HWY_NAMESPACE
}  // namespace airlight::ray_marcher
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::ray_marcher {

HWY_EXPORT(GridDensity);
void grid_density(const GridField& field, std::size_t n, const float* x, const float* y, const float* z,
                  float* density) {
  HWY_DYNAMIC_DISPATCH(GridDensity)(field, n, x, y, z, density);
}

HWY_EXPORT(GridColumns);
long long grid_columns(const GridField& field, const StepRule& rule, bool skip, std::size_t n, const LocalRays& rays,
                       float* column) {
  return HWY_DYNAMIC_DISPATCH(GridColumns)(field, rule, skip, n, rays, column);
}

}  // namespace airlight::ray_marcher
#endif
