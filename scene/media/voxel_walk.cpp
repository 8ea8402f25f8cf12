// The integral of a grid's density along a ray, from voxel face to voxel face.
//
// Every face's ray parameter is computed from its index, not by adding steps: nothing drifts. (A face that is misplaced
// by a rounding error d costs d^2, since the density is continuous.) Shadow rays spend their time here, so voxels
// inside the grid are done in SIMD registers, both Gauss points together: 8 ns per voxel where scalar code took 23.
#include <immintrin.h>

#include <cmath>

#include "scene/media/region.h"
#include "scene/media/voxel.h"

namespace airlight::scene {
namespace {

constexpr double gauss = 0.21132486540518712;  // (1 - 1/sqrt(3)) / 2

// Lanes x, y, z; the fourth never matters.
__m256d lanes(const Vec3& v, double fourth) { return _mm256_set_pd(fourth, v[2], v[1], v[0]); }

// For each of x, y, z the lesser of the two others.
__m256d lesser_of_others(__m256d v) {
  return _mm256_min_pd(_mm256_permute4x64_pd(v, 0b11001001), _mm256_permute4x64_pd(v, 0b11010010));
}

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

}  // namespace

double density_integral(const VoxelGrid& grid, const Ray& ray, Interval t) {
  if (grid.values.empty() || t.empty()) return 0;
  const auto [start, velocity] = ray_in_samples(grid, ray);
  t = clip(sample_support(grid), {start, velocity}, t);
  if (t.empty()) return 0;

  const std::ptrdiff_t row = grid.size[0], slice = row * grid.size[1];
  const std::ptrdiff_t stride[3] = {1, row, slice};
  Point3 first, inverse, base;  // face t = cell * inverse + base
  Vec3 step;
  std::ptrdiff_t advance[8] = {};  // of the sample index, for every set of axes along which the ray enters a new voxel
  std::ptrdiff_t index = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const bool still = velocity[axis] == 0;
    step[axis] = velocity[axis] > 0 ? 1 : -1;
    inverse[axis] = still ? 0 : 1 / velocity[axis];
    base[axis] = still ? infinity : ((velocity[axis] > 0 ? 1 : 0) - start[axis]) / velocity[axis];
    first[axis] = std::clamp(std::floor(start[axis] + t.lo * velocity[axis]), -1.0, grid.size[axis] - 1.0);
    index += std::ptrdiff_t(first[axis]) * stride[axis];
    for (int set = 0; set < 8; ++set) advance[set] += set >> axis & 1 ? std::ptrdiff_t(step[axis]) * stride[axis] : 0;
  }
  const __m256d origin = lanes(start, 0), direction = lanes(velocity, 0), steps = lanes(step, 0);
  const __m256d inverses = lanes(inverse, 0), bases = lanes(base, infinity);
  const __m256d last = lanes(grid.size.cast<double>().array() - 1, 0),
                inner = lanes(grid.size.cast<double>().array() - 2, 0);
  const __m256d none = _mm256_setzero_pd(), before = _mm256_set1_pd(-1);
  const auto within = [](__m256d lo, __m256d x, __m256d hi) {
    return _mm256_movemask_pd(_mm256_and_pd(_mm256_cmp_pd(x, lo, _CMP_GE_OQ), _mm256_cmp_pd(x, hi, _CMP_LE_OQ))) == 15;
  };

  __m256d cell = lanes(first, 0);
  double integral = 0;
  double enter = t.lo;
  while (true) {
    const __m256d faces = _mm256_fmadd_pd(cell, inverses, bases);
    const __m256d others = lesser_of_others(faces);
    const double face = _mm256_cvtsd_f64(_mm256_min_pd(faces, others));
    const double leave = face < t.hi ? face : t.hi;
    const double length = leave - enter;
    if (length > 0) {
      const double a = enter + gauss * length, b = leave - gauss * length;
      const __m256d shift = _mm256_sub_pd(origin, cell);
      if (within(none, cell, inner)) {
        integral += 0.5 * length * sum_at(grid.values.data() + index, row, slice, shift, direction, a, b);
      } else {
        if (!within(before, cell, last)) return integral;
        alignas(32) double c[4], s[4];
        _mm256_store_pd(c, cell);
        _mm256_store_pd(s, shift);
        const Voxel v = border_voxel(grid, int(c[0]), int(c[1]), int(c[2]));
        const auto value = [&](double at) {
          return v.at(s[0] + at * velocity[0], s[1] + at * velocity[1], s[2] + at * velocity[2]);
        };
        integral += 0.5 * length * (value(a) + value(b));
      }
      enter = leave;
    }
    if (!(face < t.hi)) return integral;
    const __m256d entered = _mm256_cmp_pd(faces, others, _CMP_LE_OQ);
    cell = _mm256_add_pd(cell, _mm256_and_pd(entered, steps));
    index += advance[_mm256_movemask_pd(entered) & 7];
  }
}

}  // namespace airlight::scene
