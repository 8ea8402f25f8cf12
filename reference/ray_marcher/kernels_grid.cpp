#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/ray_marcher/kernels_grid.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/highway.h>

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
  const float* values;
  const float* free_distance;
  VI row, slice;  // strides of the samples
  VI brick_row, brick_slice;
  std::ptrdiff_t next_row, next_slice;
};

View view_of(const GridField& field) {
  const I i;
  return {field.values.data(),
          field.free_distance.data(),
          hn::Set(i, field.size[0]),
          hn::Set(i, field.size[0] * field.size[1]),
          hn::Set(i, field.bricks[0]),
          hn::Set(i, field.bricks[0] * field.bricks[1]),
          field.size[0],
          std::ptrdiff_t(field.size[0]) * field.size[1]};
}

HWY_INLINE VF trilinear(const View& view, VF x, VF y, VF z) {
  const F f;
  const I i;
  // Local coordinates are positive, so that truncation is the floor.
  const VI ix = hn::ConvertTo(i, x), iy = hn::ConvertTo(i, y), iz = hn::ConvertTo(i, z);
  const VF fx = hn::Sub(x, hn::ConvertTo(f, ix)), fy = hn::Sub(y, hn::ConvertTo(f, iy)),
           fz = hn::Sub(z, hn::ConvertTo(f, iz));
  const VI at = hn::Add(ix, hn::Add(hn::Mul(iy, view.row), hn::Mul(iz, view.slice)));
  const auto edge = [&](const float* base) HWY_ATTR {
    const VF a = hn::GatherIndex(f, base, at), b = hn::GatherIndex(f, base + 1, at);
    return hn::MulAdd(fx, hn::Sub(b, a), a);
  };
  const auto face = [&](const float* base) HWY_ATTR {
    const VF a = edge(base), b = edge(base + view.next_row);
    return hn::MulAdd(fy, hn::Sub(b, a), a);
  };
  const VF a = face(view.values), b = face(view.values + view.next_slice);
  return hn::MulAdd(fz, hn::Sub(b, a), a);
}

HWY_INLINE VF free_distance(const View& view, VF x, VF y, VF z) {
  const F f;
  const I i;
  constexpr int shift = GridField::brick_shift;
  const VI bx = hn::ShiftRight<shift>(hn::ConvertTo(i, x)), by = hn::ShiftRight<shift>(hn::ConvertTo(i, y)),
           bz = hn::ShiftRight<shift>(hn::ConvertTo(i, z));
  const VI at = hn::Add(bx, hn::Add(hn::Mul(by, view.brick_row), hn::Mul(bz, view.brick_slice)));
  return hn::GatherIndex(f, view.free_distance, at);
}

void GridDensity(const GridField& field, std::size_t n, const float* x, const float* y, const float* z,
                 float* density) {
  const F f;
  const View view = view_of(field);
  for (std::size_t i = 0; i < n; i += hn::Lanes(f)) {
    const auto used = hn::FirstN(f, n - i);
    const auto load = [&](const float* p) HWY_ATTR { return hn::IfThenElseZero(used, hn::LoadU(f, p + i)); };
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
    const VF length = hn::Max(zero, hn::Sub(hn::LoadU(f, rays.t1 + i), t0));
    VF steps = hn::Set(f, float(rule.count));
    if (rule.length > 0)
      steps = hn::Min(hn::Max(one, hn::Ceil(hn::Div(length, hn::Set(f, rule.length)))), hn::Set(f, 1048576.0f));
    const VF h = hn::Div(length, steps);
    const VF dx = hn::LoadU(f, rays.dx + i), dy = hn::LoadU(f, rays.dy + i), dz = hn::LoadU(f, rays.dz + i);
    const VF ox = hn::MulAdd(t0, dx, hn::LoadU(f, rays.ox + i)), oy = hn::MulAdd(t0, dy, hn::LoadU(f, rays.oy + i)),
             oz = hn::MulAdd(t0, dz, hn::LoadU(f, rays.oz + i));
    // Steps per cell of the largest component: how many steps a free distance is worth.
    const VF pace = hn::Div(one, hn::Mul(h, hn::Max(hn::Abs(dx), hn::Max(hn::Abs(dy), hn::Abs(dz)))));
    VF step = zero, sum = zero;
    auto running = hn::And(hn::Gt(length, zero), hn::FirstN(f, n - i));
    const auto position = [&](VF o, VF d) HWY_ATTR { return hn::MulAdd(hn::Mul(hn::Add(step, half), h), d, o); };
    while (!hn::AllFalse(f, running)) {
      const VF x = hn::IfThenElseZero(running, position(ox, dx)), y = hn::IfThenElseZero(running, position(oy, dy)),
               z = hn::IfThenElseZero(running, position(oz, dz));
      const VF value = hn::IfThenElseZero(running, trilinear(view, x, y, z));
      sum = hn::Add(sum, value);
      evaluations += hn::CountTrue(f, running);
      step = hn::Add(step, one);
      // The map is asked only when all lanes have come to where there is nothing: within the smoke it costs nothing.
      if (skip && hn::AllTrue(f, hn::Eq(value, zero))) {
        const VF free = free_distance(view, x, y, z);
        step = hn::Add(step, hn::Floor(hn::Mul(hn::Max(free, zero), pace)));
      }
      running = hn::And(running, hn::Lt(step, steps));
    }
    hn::StoreU(hn::MulAdd(sum, h, hn::LoadU(f, column + i)), f, column + i);
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
