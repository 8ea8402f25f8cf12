// The integral of a grid's density along a ray, from voxel face to voxel face.
//
// A face that is misplaced by a rounding error d costs d^2, since the density is continuous. Shadow rays spend their
// time here, so voxels inside the grid are done in SIMD registers, both Gauss points together.
#include <algorithm>

#include "scene/media/grid_steps.h"
#include "scene/media/region.h"
#include "scene/media/voxel.h"

namespace airlight::scene {
namespace {

constexpr double gauss = 0.21132486540518712;  // (1 - 1/sqrt(3)) / 2

// Sum of the density at ray parameters a and b in the voxel at p. `shift` is the ray's origin seen from the voxel's
// least corner.
double sum_at(const float* p, std::ptrdiff_t row, std::ptrdiff_t slice, __m256d shift, __m256d direction, double a,
              double b) {
  const auto pair = [](const float* q) {
    return _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)));
  };
  const __m128 z0 = _mm_unpacklo_ps(pair(p), pair(p + row));                  // 000 010 100 110
  const __m128 z1 = _mm_unpacklo_ps(pair(p + slice), pair(p + slice + row));  // 001 011 101 111
  const __m128i any = _mm_castps_si128(_mm_or_ps(z0, z1));
  if (_mm_testz_si128(any, any)) return 0;
  const __m256d x0 = _mm256_cvtps_pd(_mm_movelh_ps(z0, z1));  // 000 010 001 011
  const __m256d x1 = _mm256_cvtps_pd(_mm_movehl_ps(z1, z0));  // 100 110 101 111
  const __m256d along_x = _mm256_sub_pd(x1, x0);

  // Position within the voxel at a and b, axis by axis.
  const __m256d t = _mm256_set_pd(b, a, b, a);
  const auto position = [&](__m256d at, auto axis) {
    constexpr int all = axis * 0b01010101;
    return _mm256_fmadd_pd(at, _mm256_permute4x64_pd(direction, all), _mm256_permute4x64_pd(shift, all));
  };
  using X = std::integral_constant<int, 0>;
  using Y = std::integral_constant<int, 1>;
  using Z = std::integral_constant<int, 2>;
  const __m256d at_a = _mm256_fmadd_pd(position(_mm256_set1_pd(a), X{}), along_x, x0);
  const __m256d at_b = _mm256_fmadd_pd(position(_mm256_set1_pd(b), X{}), along_x, x0);
  const __m256d y0 = _mm256_unpacklo_pd(at_a, at_b);  // z0: a b, z1: a b
  const __m256d y1 = _mm256_unpackhi_pd(at_a, at_b);
  const __m256d plane = _mm256_fmadd_pd(position(t, Y{}), _mm256_sub_pd(y1, y0), y0);
  const __m128d lower = _mm256_castpd256_pd128(plane), upper = _mm256_extractf128_pd(plane, 1);
  const __m128d value = _mm_fmadd_pd(_mm256_castpd256_pd128(position(t, Z{})), _mm_sub_pd(upper, lower), lower);
  return _mm_cvtsd_f64(value) + _mm_cvtsd_f64(_mm_unpackhi_pd(value, value));
}

// The part of a ray in one voxel.
struct Crossing {
  __m256d cell;
  double enter, leave;
  std::ptrdiff_t index;
  bool inner;  // all eight samples are the grid's own
};

// Sum of the density at ray parameters a and b in a voxel at the border, some of whose samples are not the grid's.
double sum_at_border(const VoxelGrid& grid, __m256d cell, __m256d shift, const Vec3& velocity, double a, double b) {
  alignas(32) double at[4], s[4];
  _mm256_store_pd(at, cell);
  _mm256_store_pd(s, shift);
  const Voxel v = border_voxel(grid, int(at[0]), int(at[1]), int(at[2]));
  const auto value = [&](double t) {
    return v.at(s[0] + t * velocity[0], s[1] + t * velocity[1], s[2] + t * velocity[2]);
  };
  return value(a) + value(b);
}

}  // namespace

double density_integral(const VoxelGrid& grid, const Ray& ray, Interval t) {
  if (grid.values.empty() || t.empty()) return 0;
  const auto [start, velocity] = ray_in_samples(grid, ray);
  t = clip(sample_support(grid), {start, velocity}, t);
  if (t.empty()) return 0;

  const std::ptrdiff_t row = grid.size[0], slice = row * grid.size[1];
  GridSteps steps({start, velocity}, t.lo, Point3::Constant(-1), grid.size.cast<double>().array() - 1, {1, row, slice});
  const auto lanes = GridSteps::lanes;
  const __m256d origin = lanes(start, 0), direction = lanes(velocity, 0);
  const __m256d none = _mm256_setzero_pd(), before = _mm256_set1_pd(-1);
  const __m256d last = lanes(grid.size.cast<double>().array() - 1, 0),
                inner = lanes(grid.size.cast<double>().array() - 2, 0);

  // Voxels are found some way ahead of being read, so that their samples have time to arrive from the outer caches:
  // a ray across a large grid waits for little else.
  constexpr int most = 24;
  Crossing crossings[most];
  const float* values = grid.values.data();
  double integral = 0;
  double enter = t.lo;
  for (bool done = false; !done;) {
    int count = 0;
    for (; count < most && !done; steps.advance()) {
      const double leave = steps.exit() < t.hi ? steps.exit() : t.hi;
      done = !(steps.exit() < t.hi);
      if (!(leave > enter)) continue;
      const bool is_inner = steps.within(none, inner);
      if (!is_inner && !steps.within(before, last)) {
        done = true;
        break;
      }
      const float* p = values + steps.index();
      if (is_inner)
        for (const float* q : {p, p + row, p + slice, p + slice + row})
          _mm_prefetch(reinterpret_cast<const char*>(q), _MM_HINT_T0);
      crossings[count++] = {steps.cell(), enter, leave, steps.index(), is_inner};
      enter = leave;
    }
    for (int i = 0; i < count; ++i) {
      const Crossing& c = crossings[i];
      const double length = c.leave - c.enter;
      const double a = c.enter + gauss * length, b = c.leave - gauss * length;
      const __m256d shift = _mm256_sub_pd(origin, c.cell);
      if (c.inner)
        integral += 0.5 * length * sum_at(values + c.index, row, slice, shift, direction, a, b);
      else
        integral += 0.5 * length * sum_at_border(grid, c.cell, shift, velocity, a, b);
    }
  }
  return integral;
}

}  // namespace airlight::scene
