#include "scene/convert/fit_objective.h"

#include <algorithm>

#include "scene/base/threads.h"

namespace airlight::scene {

using namespace separable;

namespace {

constexpr int slab = 2;  // slices that one task adds Gaussians to

}  // namespace

template <class T>
FitObjective<T>::FitObjective(const Eigen::Vector3i& size, const T* values, double scale, double cutoff, int threads)
    : layout_(Layout::of<T>(size)),
      threads_(threads_for(threads)),
      cutoff_(cutoff),
      density_(layout_.rows() * layout_.blocks * lanes),
      error_(layout_.rows() * layout_.blocks * lanes),
      data_(layout_.rows(), Hull{0, 0}),
      tables_(layout_, cutoff, true),
      arena_(threads_) {
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    T* const to = density_.data() + row * layout_.blocks * lanes;
    const T* const from = values + row * size[0];
    Hull& hull = data_[row];
    for (int i = 0; i < layout_.blocks * lanes; ++i) {
      to[i] = i < size[0] ? T(double(from[i]) * scale) : T(0);
      if (to[i] == 0) continue;
      if (hull.end == 0) hull.begin = i / lanes;
      hull.end = i / lanes + 1;
      ++filled_;
      density2_ += double(to[i]) * to[i];
      greatest_ = std::max(greatest_, double(to[i]));
    }
  }
  hull_ = data_;
  value({});
  evaluations_ = 0;
}

// Widens a row's hull; what is new is empty.
template <class T>
void FitObjective<T>::reach(std::size_t row, int begin, int end) {
  Hull& hull = hull_[row];
  if (begin >= hull.begin && end <= hull.end) return;
  V* const e = row_of(row);
  if (hull.begin == hull.end) hull = {begin, begin};
  for (int b = begin; b < hull.begin; ++b) e[b] = V{};
  for (int b = hull.end; b < end; ++b) e[b] = V{};
  hull = {std::min(hull.begin, begin), std::max(hull.end, end)};
}

template <class T>
double FitObjective<T>::slices(int z0, int z1) {
  const std::size_t first = layout_.row(0, z0), last = layout_.row(0, z1);
  for (std::size_t row = first; row < last; ++row) {
    hull_[row] = data_[row];
    V* const e = row_of(row);
    const V* const d = reinterpret_cast<const V*>(density_.data()) + row * layout_.blocks;
    for (int b = data_[row].begin; b < data_[row].end; ++b) e[b] = -d[b];
  }
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const auto& p = tables_.part(i);
    if (p.empty() || p.hi[2] < z0 || p.lo[2] >= z1) continue;
    const V *const ex = reinterpret_cast<const V*>(tables_.along_x(p)), *const d2 = ex + 2 * p.width_in_blocks;
    tables_.all_rows(p, z0, z1, [&](int y, int z, T rest, T factor, double, double) {
      const std::size_t row = layout_.row(y, z);
      reach(row, p.first_block(), p.first_block() + p.width_in_blocks);
      V* const e = row_of(row) + p.first_block();
      const T weight = factor * T(p.amplitude);
      for (int b = 0; b < p.width_in_blocks; ++b) e[b] += d2[b] < rest ? ex[b] * weight : V{};
    });
  }
  double sum = 0;
  for (std::size_t row = first; row < last; ++row) {
    V squares{};
    const V* const e = row_of(row);
    for (int b = hull_[row].begin; b < hull_[row].end; ++b) squares += e[b] * e[b];
    sum += total(squares);
  }
  return sum;
}

template <class T>
void FitObjective<T>::one_gradient(std::size_t i, double* g) const {
  const auto& p = tables_.part(i);
  std::fill_n(g, 5, 0.0);
  if (p.empty()) return;
  const V* const ex = reinterpret_cast<const V*>(tables_.along_x(p));
  const V *const d1 = ex + p.width_in_blocks, *const d2 = d1 + p.width_in_blocks;
  V plain{}, by_x{}, by_y{}, by_z{}, by_r{};
  tables_.all_rows(p, 0, layout_.size[2], [&](int y, int z, T rest, T factor, double dy, double dz) {
    const V* const e = row_of(layout_.row(y, z)) + p.first_block();
    V s0{}, s1{}, s2{};
    for (int b = 0; b < p.width_in_blocks; ++b) {
      const V value = d2[b] < rest ? e[b] * ex[b] : V{};
      s0 += value;
      s1 += value * d1[b];
      s2 += value * d2[b];
    }
    s0 *= factor;
    plain += s0;
    by_x += s1 * factor;
    by_y += s0 * T(dy);
    by_z += s0 * T(dz);
    by_r += s2 * factor + s0 * T(dy * dy + dz * dz);
  });
  const double by_center = 4 * p.amplitude / p.width2;
  g[0] = by_center * total(by_x);
  g[1] = by_center * total(by_y);
  g[2] = by_center * total(by_z);
  g[3] = by_center / std::sqrt(p.width2) * total(by_r);
  g[4] = 2 * total(plain);
}

template <class T>
double FitObjective<T>::value(const std::vector<Gaussian>& gaussians, double* gradient) {
  ++evaluations_;
  const int nz = layout_.size[2], tasks = (nz + slab - 1) / slab;
  partial_.assign(std::size_t(tasks), 0);
  arena_.execute([&] {
    tables_.make(gaussians.data(), gaussians.size());
    tbb::parallel_for(
        tbb::blocked_range<int>(0, tasks, 1),
        [&](const auto& range) {
          for (int t = range.begin(); t < range.end(); ++t)
            partial_[std::size_t(t)] = slices(t * slab, std::min((t + 1) * slab, nz));
        },
        tbb::simple_partitioner());
    if (gradient)
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, gaussians.size(), 8),
          [&](const auto& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) one_gradient(i, gradient + 5 * i);
          },
          tbb::simple_partitioner());
  });
  double sum = 0;
  for (const double part : partial_) sum += part;
  return sum;
}

template <class T>
std::vector<double> FitObjective<T>::densities(const Eigen::Vector3i& at, const Eigen::Vector3i& size) const {
  std::vector<double> values;
  for (int z = at[2]; z < at[2] + size[2]; ++z)
    for (int y = at[1]; y < at[1] + size[1]; ++y)
      for (int x = at[0]; x < at[0] + size[0]; ++x)
        values.push_back(double(density_[layout_.row(y, z) * layout_.blocks * lanes + std::size_t(x)]));
  return values;
}

template <class T>
FitErrors FitObjective<T>::errors() const {
  double all = 0, in_filled = 0;
  FitErrors errors;
  for (std::size_t row = 0; row < layout_.rows(); ++row) {
    const T *e = reinterpret_cast<const T*>(row_of(row)), *d = density_.data() + row * layout_.blocks * lanes;
    for (int i = hull_[row].begin * lanes; i < hull_[row].end * lanes; ++i) {
      const double square = double(e[i]) * e[i], size = std::abs(double(e[i]));
      all += square;
      errors.max = std::max(errors.max, size);
      if (d[i] == 0) continue;
      in_filled += square;
      errors.max_filled = std::max(errors.max_filled, size);
    }
  }
  if (filled_ == 0) return errors;
  const double voxels = double(layout_.rows()) * layout_.size[0];
  errors.squared_ratio = all / density2_;
  errors.relative_l2 = std::sqrt(errors.squared_ratio);
  errors.rms = std::sqrt(all / voxels) / greatest_;
  errors.rms_filled = std::sqrt(in_filled / double(filled_)) / greatest_;
  errors.max /= greatest_;
  errors.max_filled /= greatest_;
  return errors;
}

template <class T>
std::vector<typename FitObjective<T>::Missing> FitObjective<T>::missing(int cell) const {
  const Eigen::Vector3i cells = (layout_.size.array() + cell - 1) / cell;
  struct Sums {
    double error = 0, missing = 0;
    Point3 place = Point3::Zero();
  };
  std::vector<Sums> sums(std::size_t(cells.prod()));
  for (int z = 0; z < layout_.size[2]; ++z)
    for (int y = 0; y < layout_.size[1]; ++y) {
      const std::size_t row = layout_.row(y, z);
      const T* const e = reinterpret_cast<const T*>(row_of(row));
      Sums* const to = &sums[std::size_t(cells[0]) * (y / cell + std::size_t(cells[1]) * (z / cell))];
      for (int i = hull_[row].begin * lanes; i < std::min(hull_[row].end * lanes, layout_.size[0]); ++i) {
        Sums& s = to[i / cell];
        s.error += double(e[i]);
        if (!(e[i] < 0)) continue;
        s.missing -= double(e[i]);
        s.place -= double(e[i]) * Point3(i, y, z);
      }
    }
  std::vector<Missing> found;
  for (std::size_t c = 0; c < sums.size(); ++c)
    if (sums[c].error < 0) found.push_back({c, sums[c].error, sums[c].place / sums[c].missing});
  return found;
}

template <class T>
void FitObjective<T>::add(const Gaussian& g) {
  Tables<T> one(layout_, cutoff_, false);
  one.make(&g, 1);
  const auto& p = one.part(0);
  if (p.empty()) return;
  const V* const ex = reinterpret_cast<const V*>(one.along_x(p)) - p.first_block();
  one.rows(p, 0, layout_.size[2], [&](int y, int z, int begin, int end, T factor, double, double) {
    const std::size_t row = layout_.row(y, z);
    reach(row, begin / lanes, end / lanes + 1);
    for (int b = begin / lanes; b <= end / lanes; ++b)
      row_of(row)[b] += within<T>(b, begin, end) ? ex[b] * T(factor * p.amplitude) : V{};
  });
}

template <class T>
std::pair<double, double> FitObjective<T>::correlation(const Gaussian& g) const {
  Tables<T> one(layout_, cutoff_, false);
  Gaussian unit = g;
  unit.amplitude = 1;
  one.make(&unit, 1);
  const auto& p = one.part(0);
  if (p.empty()) return {0, 0};
  const V* const ex = reinterpret_cast<const V*>(one.along_x(p)) - p.first_block();
  V with_error{}, with_itself{};
  one.rows(p, 0, layout_.size[2], [&](int y, int z, int begin, int end, T factor, double, double) {
    const std::size_t row = layout_.row(y, z);
    for (int b = begin / lanes; b <= end / lanes; ++b) {
      const V value = within<T>(b, begin, end) ? ex[b] * factor : V{};
      with_itself += value * value;
      // Beyond the hull E is 0, whatever lies in memory.
      if (b >= hull_[row].begin && b < hull_[row].end) with_error += value * row_of(row)[b];
    }
  });
  return {total(with_error), total(with_itself)};
}

template class FitObjective<float>;
template class FitObjective<double>;

}  // namespace airlight::scene
