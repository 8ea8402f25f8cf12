#include "methods/compensated_ray_marching/grid_columns.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/compensated_ray_marching/grid_columns.cpp"
#include <hwy/foreach_target.h>
// Above: this file is compiled once per instruction set.
#include <hwy/highway.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#ifndef AIRLIGHT_GRID_COLUMNS_ONCE
#define AIRLIGHT_GRID_COLUMNS_ONCE
namespace airlight::compensated_ray_marching {

// Samples, and what one to the next row and slice adds to their number.
struct Samples {
  const float* values;
  int row, slice;
};
// Rays where they begin: place within a voxel, its first sample, length [samples]. With room for whole vectors.
struct RayStarts {
  std::size_t count = 0;
  std::vector<float> x, y, z, length;
  std::vector<int> sample;
};

}  // namespace airlight::compensated_ray_marching
#endif

HWY_BEFORE_NAMESPACE();
namespace airlight::compensated_ray_marching::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 8>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
constexpr F f;
constexpr I i32;

// One axis of parallel rays: what a voxel's faces are to them.
struct Axis {
  VF velocity, inverse, far, near;
  VI step;

  Axis(float v, int stride) {
    const bool still = !(std::abs(v) > 1e-20f);  // then the next face is never reached
    velocity = hn::Set(f, v);
    inverse = hn::Set(f, still ? 1e30f : 1 / v);
    far = hn::Set(f, still ? 2.0f : v > 0 ? 1.0f : 0.0f);
    near = hn::Set(f, v > 0 ? 0.0f : 1.0f);
    step = hn::Set(i32, v > 0 ? stride : -stride);
  }
  HWY_INLINE VF to_face(VF place) const { return (far - place) * inverse; }
  // On by `length`; into the next voxel where `enters`.
  HWY_INLINE void advance(hn::Mask<F> enters, VF length, VF& place, VI& sample) const {
    place = IfThenElse(enters, near, MulAdd(length, velocity, place));
    sample = sample + IfThenElseZero(hn::RebindMask(i32, enters), step);
  }
};

HWY_INLINE VF mix(VF a, VF b, VF share) { return MulAdd(share, b - a, a); }

// Sums of each ray, voxel by voxel, whatever the others do: the bits do not depend on how many are walked together.
void Columns(const Samples& samples, const float* velocity, const RayStarts& rays, float* columns) {
  constexpr float gauss = 0.21132487f;  // (1 - 1/sqrt(3)) / 2
  const std::size_t lanes = hn::Lanes(f);
  const Axis along_x(velocity[0], 1), along_y(velocity[1], samples.row), along_z(velocity[2], samples.slice);
  for (std::size_t i = 0; i < rays.count; i += lanes) {
    VF x = hn::LoadU(f, rays.x.data() + i), y = hn::LoadU(f, rays.y.data() + i), z = hn::LoadU(f, rays.z.data() + i);
    VF left = hn::LoadU(f, rays.length.data() + i), sum = hn::Zero(f);
    VI sample = hn::LoadU(i32, rays.sample.data() + i);
    for (auto under_way = left > hn::Zero(f); !hn::AllFalse(f, under_way); under_way = left > hn::Zero(f)) {
      const VF to_x = along_x.to_face(x), to_y = along_y.to_face(y), to_z = along_z.to_face(z);
      const VF length = Max(Min(Min(to_x, to_y), Min(to_z, left)), hn::Zero(f));
      const auto corner = [&](int offset) HWY_ATTR { return hn::GatherIndex(f, samples.values + offset, sample); };
      const int row = samples.row, slice = samples.slice;
      const VF v000 = corner(0), v100 = corner(1), v010 = corner(row), v110 = corner(row + 1);
      const VF v001 = corner(slice), v101 = corner(slice + 1), v011 = corner(slice + row),
               v111 = corner(slice + row + 1);
      const auto value = [&](VF t) HWY_ATTR {
        const VF sx = MulAdd(t, along_x.velocity, x), sy = MulAdd(t, along_y.velocity, y);
        const VF lower = mix(mix(v000, v100, sx), mix(v010, v110, sx), sy);
        const VF upper = mix(mix(v001, v101, sx), mix(v011, v111, sx), sy);
        return mix(lower, upper, MulAdd(t, along_z.velocity, z));
      };
      const VF first = length * hn::Set(f, gauss);
      sum = MulAdd(hn::Set(f, 0.5f) * length, value(first) + value(length - first), sum);
      const auto enters = [&](VF to_face) HWY_ATTR { return And(under_way, to_face <= length); };
      along_x.advance(enters(to_x), length, x, sample);
      along_y.advance(enters(to_y), length, y, sample);
      along_z.advance(enters(to_z), length, z, sample);
      left = left - length;
    }
    hn::BlendedStore(sum, hn::FirstN(f, std::min(lanes, rays.count - i)), f, columns + i);
  }
}

}  // namespace airlight::compensated_ray_marching::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::compensated_ray_marching {
HWY_EXPORT(Columns);

bool GridColumns::knows(const scene::VoxelGrid& grid) {
  const auto voxels = (grid.size.cast<double>().array() + (2 * pad + 1)).prod();
  return !grid.values.empty() && voxels < double(std::numeric_limits<int>::max());
}

GridColumns::GridColumns(const scene::VoxelGrid& grid)
    : grid_(grid), row_(grid.size[0] + 2 * pad), slice_(row_ * (grid.size[1] + 2 * pad)) {
  values_.assign(std::size_t(slice_) * std::size_t(grid.size[2] + 2 * pad), 0.0F);
  const int edge = grid.clamp_border ? pad : 0;  // how far beyond the samples the nearest one goes on
  float* to = values_.data();
  const auto inside = [&](int k, int axis) { return k >= -edge && k < grid.size[axis] + edge; };
  const auto nearest = [&](int k, int axis) { return std::clamp(k, 0, grid.size[axis] - 1); };
  for (int k = -pad; k < grid.size[2] + pad; ++k)
    for (int j = -pad; j < grid.size[1] + pad; ++j)
      for (int i = -pad; i < grid.size[0] + pad; ++i, ++to)
        if (inside(i, 0) && inside(j, 1) && inside(k, 2)) *to = grid.at(nearest(i, 0), nearest(j, 1), nearest(k, 2));
}

void GridColumns::from(const std::vector<Point3>& points, const Vec3& direction, const scene::Region& region,
                       float* columns) const {
  constexpr std::size_t most_lanes = 16;
  const Box support = sample_support(grid_);
  const Vec3 unit = ray_in_samples(grid_, {Point3::Zero(), direction}).direction * grid_.voxel_size;
  RayStarts rays;
  rays.count = points.size();
  const std::size_t room = rays.count + most_lanes;
  for (std::vector<float>* of : {&rays.x, &rays.y, &rays.z, &rays.length}) of->assign(room, 0.0F);
  rays.sample.assign(room, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Interval inside = scene::clip(region, {points[i], direction}, {0, infinity});
    const Ray ray{world_to_sample(grid_, points[i]), unit};
    const Interval t = scene::clip(support, ray, {inside.lo / grid_.voxel_size, inside.hi / grid_.voxel_size});
    if (inside.empty() || t.empty()) continue;
    const Point3 start = ray.at(t.lo);
    int sample = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const double voxel = std::clamp(std::floor(start[axis]), -1.0, grid_.size[axis] - 1.0);
      (axis == 0 ? rays.x : axis == 1 ? rays.y : rays.z)[i] = float(std::clamp(start[axis] - voxel, 0.0, 1.0));
      sample += (int(voxel) + pad) * (axis == 0 ? 1 : axis == 1 ? row_ : slice_);
    }
    rays.sample[i] = sample;
    rays.length[i] = float(t.length());
  }
  const float velocity[3] = {float(unit[0]), float(unit[1]), float(unit[2])};
  HWY_DYNAMIC_DISPATCH(Columns)({values_.data(), row_, slice_}, velocity, rays, columns);
  for (std::size_t i = 0; i < points.size(); ++i) columns[i] *= float(grid_.voxel_size);
}

}  // namespace airlight::compensated_ray_marching
#endif
