// Isotropic Gaussians sampled on a regular grid, by what makes that cheap: exp(-|x|^2) is the product of three 1D tables, so that no
// exponential stands in the loop over voxels, and a row along x of the cut-off ball is one run of voxels, vectorised.
//
// For gaussian_samples and the fit alone. All in samples: sample (i, j, k) sits at (i, j, k), rows run along x and are padded to whole
// vectors.
#pragma once
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "scene/math/types.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::scene::separable {

// One register of T, its masks, and loads. T = float or double.
template <class T>
struct Lanes;
template <>
struct Lanes<float> {
  using Vector = float __attribute__((vector_size(32)));
  using Mask = std::int32_t __attribute__((vector_size(32)));
  static constexpr int count = 8;
  static constexpr Mask places = {0, 1, 2, 3, 4, 5, 6, 7};
};
template <>
struct Lanes<double> {
  using Vector = double __attribute__((vector_size(32)));
  using Mask = std::int64_t __attribute__((vector_size(32)));
  static constexpr int count = 4;
  static constexpr Mask places = {0, 1, 2, 3};
};

template <class T>
using Vector = typename Lanes<T>::Vector;

// A fixed order of addition, whatever the compiler.
inline double total(Vector<float> v) {
  return ((double(v[0]) + v[4]) + (double(v[2]) + v[6])) + ((double(v[1]) + v[5]) + (double(v[3]) + v[7]));
}
inline double total(Vector<double> v) { return (v[0] + v[2]) + (v[1] + v[3]); }

// Memory for vectors of T, not initialised.
template <class T>
class Aligned {
 public:
  Aligned() = default;
  explicit Aligned(std::size_t size) { resize(size); }
  void resize(std::size_t size) {  // contents are lost where it grows
    if (size > room_) {
      memory_.reset(static_cast<T*>(std::aligned_alloc(64, (size * sizeof(T) + 63) / 64 * 64)));
      if (!memory_) throw std::bad_alloc();
      room_ = size;
    }
    size_ = size;
  }
  std::size_t size() const { return size_; }
  T* data() { return memory_.get(); }
  const T* data() const { return memory_.get(); }
  T& operator[](std::size_t i) { return memory_.get()[i]; }
  const T& operator[](std::size_t i) const { return memory_.get()[i]; }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T, Free> memory_;
  std::size_t size_ = 0, room_ = 0;
};

// A grid of rows of whole vectors.
struct Layout {
  Eigen::Vector3i size;
  int blocks;  // vectors a row
  template <class T>
  static Layout of(const Eigen::Vector3i& size) {
    return {size, (size[0] + Lanes<T>::count - 1) / Lanes<T>::count};
  }
  std::size_t row(int y, int z) const { return std::size_t(z) * size[1] + y; }
  std::size_t rows() const { return std::size_t(size[1]) * size[2]; }
};

// A Gaussian at a place in samples, with a width in samples.
using SampleGaussian = Gaussian;

template <class T>
class Tables {
 public:
  // cutoff [widths] as in GaussianSum; Gaussians end at most where they fall below the least normal T. With `moments`, also the tables
  // that gradients need.
  Tables(const Layout& layout, double cutoff, bool moments)
      : layout_(layout), limit_(std::min(cutoff * cutoff, sizeof(T) == 4 ? 80.0 : 700.0)), moments_(moments) {}

  const Layout& layout() const { return layout_; }
  std::size_t size() const { return parts_.size(); }
  double exponent_limit() const { return limit_; }

  // Runs in the arena of the caller; the same bits for any number of threads.
  void make(const SampleGaussian* gaussians, std::size_t n);

  struct Part {
    Point3 center;
    double width2, amplitude;
    int lo[3], hi[3];  // samples that it reaches; empty where lo > hi on any axis
    std::size_t at;    // of its tables
    int width_in_blocks;
    bool empty() const { return lo[0] > hi[0] || lo[1] > hi[1] || lo[2] > hi[2]; }
    int first_block() const { return lo[0] / Lanes<T>::count; }
  };
  const Part& part(std::size_t i) const { return parts_[i]; }
  // exp(-dx^2/w^2), from the first block on; with moments, dx after it and dx^2 after that, infinite beyond the grid.
  const T* along_x(const Part& p) const { return values_.data() + p.at; }
  const T* along_y(const Part& p) const {
    return along_x(p) + (moments_ ? 3 : 1) * p.width_in_blocks * Lanes<T>::count;
  }
  const T* along_z(const Part& p) const { return along_y(p) + (p.hi[1] - p.lo[1] + 1); }

  // The run of samples of row (y, z) within the cut-off ball: the same ones that `density` counts, but for rounding.
  // rest = limit w^2 - dy^2 - dz^2 > 0.
  std::pair<int, int> run(const Part& p, double across2, double rest) const {
    const double half = std::sqrt(rest), cx = p.center[0];
    double a = std::ceil(cx - half), b = std::floor(cx + half);
    // The ball is open: where a sample is about on it, the test decides that `density` makes.
    const auto inside = [&](double x) { return ((x - cx) * (x - cx) + across2) / p.width2 < limit_; };
    if (a - (cx - half) < 1e-9 && !inside(a)) a += 1;
    if ((cx + half) - b < 1e-9 && !inside(b)) b -= 1;
    return {std::max(int(a), p.lo[0]), std::min(int(b), p.hi[0])};
  }

  // body(y, z, first, last, factor, dy, dz) for every row with samples in it, z in [z0, z1).
  template <class Body>
  void rows(const Part& p, int z0, int z1, Body&& body) const {
    if (p.empty()) return;
    const T *ey = along_y(p) - p.lo[1], *ez = along_z(p) - p.lo[2];
    for (int z = std::max(z0, p.lo[2]); z <= std::min(z1 - 1, p.hi[2]); ++z) {
      const double dz = z - p.center[2], slice = limit_ * p.width2 - dz * dz;
      if (!(slice > 0)) continue;
      for (int y = p.lo[1]; y <= p.hi[1]; ++y) {
        const double dy = y - p.center[1], rest = slice - dy * dy;
        if (!(rest > 0)) continue;
        const auto [first, last] = run(p, dy * dy + dz * dz, rest);
        if (first <= last) body(y, z, first, last, ey[y] * ez[z], dy, dz);
      }
    }
  }

  // A variant of rows() for loops over whole vectors of the Gaussian's tables, faster where many rows are short. A
  // sample belongs to the ball where dx^2 < rest, compared in T. Calls body(y, z, rest, factor, dy, dz).
  template <class Body>
  void all_rows(const Part& p, int z0, int z1, Body&& body) const {
    if (p.empty()) return;
    const T *ey = along_y(p) - p.lo[1], *ez = along_z(p) - p.lo[2];
    for (int z = std::max(z0, p.lo[2]); z <= std::min(z1 - 1, p.hi[2]); ++z) {
      const double dz = z - p.center[2], slice = limit_ * p.width2 - dz * dz;
      if (!(slice > 0)) continue;
      const double half = std::sqrt(slice) * (1 + 1e-12);
      const int first = std::max(p.lo[1], int(std::ceil(p.center[1] - half)));
      const int last = std::min(p.hi[1], int(std::floor(p.center[1] + half)));
      for (int y = first; y <= last; ++y) {
        const double dy = y - p.center[1];
        body(y, z, T(slice - dy * dy), ey[y] * ez[z], dy, dz);
      }
    }
  }

 private:
  Layout layout_;
  double limit_;
  bool moments_;
  std::vector<Part> parts_;
  Aligned<T> values_;
};

// The lanes of vector `block` whose samples lie in [first, last].
template <class T>
typename Lanes<T>::Mask within(int block, int first, int last) {
  const typename Lanes<T>::Mask x = Lanes<T>::places + block * Lanes<T>::count;
  return (x >= first) & (x <= last);
}

extern template class Tables<float>;
extern template class Tables<double>;

}  // namespace airlight::scene::separable
