// Objective of a fit of Gaussians: sum over voxels of E^2, E = sum w B - D, and its gradient. Zhou et al. 2008, Eq. 9.
//
// All in samples of the grid: sample (i, j, k) sits at (i, j, k), widths are counted in voxels.
#pragma once
#include <tbb/task_arena.h>

#include "scene/convert/separable_gaussians.h"

namespace airlight::scene {

// Differences between a fit and its grid. E = fit - density, over all voxels.
struct FitErrors {
  double squared_ratio = 0;  // sum E^2 / sum D^2: the publication's "relative error"; 0 for an empty grid
  double relative_l2 = 0;    // its root
  // Over the greatest density; filled: voxels with density above 0.
  double rms = 0, rms_filled = 0, max = 0, max_filled = 0;
};

// T: float for fits, double where digits count. Results are bitwise equal for any number of threads: a slice adds the
// Gaussians in their order, one thread computes a Gaussian's gradient, and sums over slices run in order.
template <class T>
class FitObjective {
 public:
  // Values as in VoxelGrid, x fastest, times `scale`.
  FitObjective(const Eigen::Vector3i& size, const T* values, double scale, double cutoff, int threads);

  const Eigen::Vector3i& size() const { return layout_.size; }
  double sum_of_squares() const { return density2_; }  // of D
  std::size_t filled() const { return filled_; }
  int threads() const { return threads_; }
  // The objective; with `gradient`, its derivatives by center x, y, z [voxels], width [voxels] and amplitude, five a Gaussian.
  double value(const std::vector<Gaussian>&, double* gradient = nullptr);
  std::size_t evaluations() const { return evaluations_; }

  // D of the samples of a box, x fastest.
  std::vector<double> densities(const Eigen::Vector3i& at, const Eigen::Vector3i& size) const;

  // About the Gaussians of the last value():
  FitErrors errors() const;
  // Cubic cells in which density is missing: their sums of E below 0, and the mean place of what is missing.
  struct Missing {
    std::size_t cell;
    double sum;
    Point3 center;
  };
  std::vector<Missing> missing(int cell) const;
  // Adds a Gaussian to E where a later value() has not undone it, and says the objective's change.
  void add(const Gaussian&);
  // sum E B and sum B^2 over the Gaussian's samples, amplitude left out.
  std::pair<double, double> correlation(const Gaussian&) const;

 private:
  using V = separable::Vector<T>;
  static constexpr int lanes = separable::Lanes<T>::count;
  struct Hull {
    int begin, end;  // vectors of a row that hold what may differ from 0
  };
  V* row_of(std::size_t row) { return reinterpret_cast<V*>(error_.data()) + row * layout_.blocks; }
  const V* row_of(std::size_t row) const { return reinterpret_cast<const V*>(error_.data()) + row * layout_.blocks; }
  void reach(std::size_t row, int begin, int end);
  double slices(int z0, int z1);
  void one_gradient(std::size_t i, double* g) const;

  separable::Layout layout_;
  int threads_;
  double cutoff_;
  double density2_ = 0, greatest_ = 0;
  std::size_t filled_ = 0, evaluations_ = 0;
  separable::Aligned<T> density_, error_;
  std::vector<Hull> data_, hull_;
  separable::Tables<T> tables_;
  std::vector<double> partial_;
  tbb::task_arena arena_;
};

extern template class FitObjective<float>;
extern template class FitObjective<double>;

}  // namespace airlight::scene
