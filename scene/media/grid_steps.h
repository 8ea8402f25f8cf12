// Steps along a ray from cell to cell of a regular grid, the three axes at once in SIMD registers and without branches.
//
// Every face's ray parameter is computed from its index, not by adding steps: nothing drifts.
#pragma once
#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scene/math/types.h"

namespace airlight::scene {

class GridSteps {
 public:
  // A ray given in cells (cell (0,0,0) is the unit cube at the origin; `direction` need not be unit), from parameter t
  // on. The first cell is clamped to [least, last] per axis. `stride`: what one cell along each axis adds to the index.
  GridSteps(const Ray& ray, double t, const Point3& least, const Point3& last, const std::ptrdiff_t (&stride)[3]) {
    Point3 first, inverse, base;  // face t = cell * inverse + base
    Vec3 step;
    for (int axis = 0; axis < 3; ++axis) {
      const double velocity = ray.direction[axis];
      const bool still =
          !(std::abs(velocity) > 1e-290);  // below it no face is ever reached, and 1 / velocity overflows
      step[axis] = velocity > 0 ? 1 : -1;
      inverse[axis] = still ? 0 : 1 / velocity;
      base[axis] = still ? infinity : ((velocity > 0 ? 1 : 0) - ray.origin[axis]) / velocity;
      first[axis] = std::clamp(std::floor(ray.origin[axis] + t * velocity), least[axis], last[axis]);
      index_ += std::ptrdiff_t(first[axis]) * stride[axis];
      for (int set = 0; set < 8; ++set)
        advance_[set] += set >> axis & 1 ? std::ptrdiff_t(step[axis]) * stride[axis] : 0;
    }
    cell_ = lanes(first, 0);
    steps_ = lanes(step, 0);
    inverses_ = lanes(inverse, 0);
    bases_ = lanes(base, infinity);
    look();
  }

  // The lanes are x, y, z; the fourth never matters.
  static __m256d lanes(const Vec3& v, double fourth) { return _mm256_set_pd(fourth, v[2], v[1], v[0]); }

  __m256d cell() const { return cell_; }
  std::ptrdiff_t index() const { return index_; }
  // Ray parameter of the face through which the ray leaves the cell.
  double exit() const { return exit_; }
  // Does the cell lie within [lo, hi], lane by lane?
  bool within(__m256d lo, __m256d hi) const {
    const __m256d inside = _mm256_and_pd(_mm256_cmp_pd(cell_, lo, _CMP_GE_OQ), _mm256_cmp_pd(cell_, hi, _CMP_LE_OQ));
    return _mm256_movemask_pd(inside) == 15;
  }
  // Into the cell beyond that face; through an edge or a corner at once.
  void advance() {
    const __m256d entered = _mm256_cmp_pd(faces_, others_, _CMP_LE_OQ);
    cell_ = _mm256_add_pd(cell_, _mm256_and_pd(entered, steps_));
    index_ += advance_[_mm256_movemask_pd(entered) & 7];
    look();
  }

 private:
  void look() {
    faces_ = _mm256_fmadd_pd(cell_, inverses_, bases_);
    // For each of x, y, z the lesser of the two others.
    others_ = _mm256_min_pd(_mm256_permute4x64_pd(faces_, 0b11001001), _mm256_permute4x64_pd(faces_, 0b11010010));
    exit_ = _mm256_cvtsd_f64(_mm256_min_pd(faces_, others_));
  }

  __m256d cell_, faces_, others_, steps_, inverses_, bases_;
  double exit_;
  std::ptrdiff_t index_ = 0;
  std::ptrdiff_t advance_[8] = {};  // of the index, for every set of axes along which the ray enters a new cell
};

}  // namespace airlight::scene
