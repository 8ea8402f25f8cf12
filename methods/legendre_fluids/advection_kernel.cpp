#include "methods/legendre_fluids/advection_kernel.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/legendre_fluids/advection_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "methods/legendre_fluids/columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::legendre_fluids::HWY_NAMESPACE {

using Field = AdvectionKernel::Field;

class Pass {
 public:
  Pass(int dimensions, const std::array<Tables, 2>& tables, const std::vector<Field>& fields)
      : d_(dimensions), t_(tables), f_(fields), m_(tables[0].points), q_(d_ == 3 ? m_ * m_ : m_) {}

  void Run(const std::array<const double*, 3>& wind) {
    const std::size_t most = std::size_t(t_[0].count) * q_;  // numbers of an array
    memory_.resize((4 * f_.size() + 2) * most + (4 * f_.size() + 1) * Size());
    double* next = memory_.data();
    for (double** array : {&value_, &slope_}) *array = next, next += most;
    lines_.resize(f_.size());
    for (Lines& l : lines_)
      for (double** array : {&l.plain, &l.by_y, &l.by_z, &l.change}) *array = next, next += most;
    scratch_ = next;
    for (std::size_t f = 0; f < f_.size(); ++f) ToLines(f_[f], lines_[f]);
    for (int at = 0; at < q_; at += block) Line(at, Lanes(std::min(block, q_ - at)), wind);
    for (std::size_t f = 0; f < f_.size(); ++f)
      if (f_[f].to) FromLines(f_[f], lines_[f]);
  }

 private:
  // Values and slopes at all points but along x, where they are still coefficients: [x][y z].
  struct Lines {
    double *plain, *by_y, *by_z, *change;
  };
  std::size_t Size() const { return std::size_t(2 * t_[0].half) * block; }  // of a line, filled up to pairs
  const Tables& Of(const Field& f, int axis) const { return t_[f.component == axis]; }

  void ToLines(const Field& f, const Lines& lines) const {
    const int nx = Of(f, 0).count, ny = Of(f, 1).count;
    const Tables& last = Of(f, d_ - 1);
    const int rows = d_ == 3 ? nx * ny : nx;
    AlongLast(last.values_t, last.count, m_, rows, f.from, d_ == 2 ? lines.plain : value_);
    AlongLast(last.slopes_t, last.count, m_, rows, f.from, d_ == 2 ? lines.by_y : slope_);
    if (d_ == 2) return;
    for (int x = 0; x < nx; ++x)
      for (int z = 0; z < m_; z += block) {
        const Lanes l(std::min(block, m_ - z));
        const std::ptrdiff_t from = std::ptrdiff_t(x) * ny * m_ + z, to = std::ptrdiff_t(x) * q_ + z;
        ToPoints(Of(f, 1), false, {value_ + from, m_}, {lines.plain + to, m_}, l);
        ToPoints(Of(f, 1), true, {value_ + from, m_}, {lines.by_y + to, m_}, l);
        ToPoints(Of(f, 1), false, {slope_ + from, m_}, {lines.by_z + to, m_}, l);
      }
  }

  // Eight lines along x: all fields to the points, products, and back.
  void Line(int at, const Lanes& l, const std::array<const double*, 3>& wind) {
    const auto scratch = [&](std::size_t f, int which) { return scratch_ + (f * 4 + which) * Size(); };
    std::array<const double*, 3> carrier{};
    for (std::size_t f = 0; f < f_.size(); ++f) {
      const Tables& x = Of(f_[f], 0);
      const Lines& from = lines_[f];
      const auto to_points = [&](const double* values, bool slope, int which) HWY_ATTR {
        ToPoints(x, slope, {values + at, q_}, {scratch(f, which), block}, l);
      };
      if (f_[f].carries) {
        to_points(from.plain, false, 3);
        carrier[f_[f].component] = scratch(f, 3);
      }
      if (!f_[f].to) continue;
      to_points(from.plain, true, 0);
      to_points(from.by_y, false, 1);
      if (d_ == 3) to_points(from.by_z, false, 2);
    }
    double* sums = scratch(f_.size(), 0);
    for (std::size_t f = 0; f < f_.size(); ++f) {
      if (!f_[f].to) continue;
      double* change = scratch(f, 0);
      for (int i = 0; i < m_; ++i)
        for (int v = 0; v < vectors; ++v) {
          V sum = hn::Zero(d);
          for (int a = 0; a < d_; ++a) {
            V w = carrier[a] ? hn::LoadU(d, carrier[a] + i * block + v * lanes) : hn::Zero(d);
            if (wind[a]) w = w + l.load(wind[a] + std::ptrdiff_t(i) * q_ + at, v);
            sum = NegMulAdd(w, hn::LoadU(d, scratch(f, a) + i * block + v * lanes), sum);
          }
          hn::StoreU(sum, d, change + i * block + v * lanes);
        }
      Fold(Of(f_[f], 0), {change, block}, sums, Lanes(block));
      ToFunctions(Of(f_[f], 0), sums, {lines_[f].change + at, q_}, l);
    }
  }

  void FromLines(const Field& f, const Lines& lines) const {
    const int nx = Of(f, 0).count, ny = Of(f, 1).count;
    const Tables& last = Of(f, d_ - 1);
    if (d_ == 2) return AlongLast(last.analysis_t, m_, last.count, nx, lines.change, f.to);
    for (int x = 0; x < nx; ++x)
      for (int z = 0; z < m_; z += block) {
        const Lanes l(std::min(block, m_ - z));
        Fold(Of(f, 1), {lines.change + std::ptrdiff_t(x) * q_ + z, m_}, scratch_, l);
        ToFunctions(Of(f, 1), scratch_, {value_ + std::ptrdiff_t(x) * ny * m_ + z, m_}, l);
      }
    AlongLast(last.analysis_t, m_, last.count, nx * ny, value_, f.to);
  }

  int d_;
  const std::array<Tables, 2>& t_;
  const std::vector<Field>& f_;
  int m_, q_;
  static thread_local std::vector<double> memory_;  // kept: pages that are new each time cost as much as the work
  double *value_ = nullptr, *slope_ = nullptr, *scratch_ = nullptr;
  std::vector<Lines> lines_;
};
thread_local std::vector<double> Pass::memory_;

void Advect(int dimensions, const std::array<Tables, 2>& tables, const std::vector<Field>& fields,
            const std::array<const double*, 3>& wind) {
  Pass(dimensions, tables, fields).Run(wind);
}

}  // namespace airlight::legendre_fluids::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace airlight::legendre_fluids {

HWY_EXPORT(Advect);

namespace {

// Rows filled up to eights.
std::vector<double> padded(const Eigen::MatrixXd& matrix) {
  const Eigen::Index columns = (matrix.cols() + 7) / 8 * 8;
  std::vector<double> rows(std::size_t(matrix.rows() * columns));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) rows[std::size_t(i * columns + j)] = matrix(i, j);
  return rows;
}
// By rows, and one more of zeros.
std::vector<double> by_rows(const Eigen::MatrixXd& matrix) {
  std::vector<double> rows(std::size_t((matrix.rows() + 1) * matrix.cols()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) rows[std::size_t(i * matrix.cols() + j)] = matrix(i, j);
  return rows;
}

AdvectionKernel::Tables tables_of(const AxisBasis& b) {
  AdvectionKernel::Tables t;
  t.count = b.count, t.points = b.points, t.half = (b.points + 1) / 2;
  t.values = by_rows(b.values.topRows(t.half));
  t.slopes = by_rows(b.slopes.topRows(t.half));
  t.analysis = by_rows(b.analysis.leftCols(t.half));
  t.values_t = padded(b.values.transpose());
  t.slopes_t = padded(b.slopes.transpose());
  t.analysis_t = padded(b.analysis.transpose());
  return t;
}

}  // namespace

AdvectionKernel::AdvectionKernel(int dimensions, const AxisBasis& free, const AxisBasis& wall)
    : d_(dimensions), tables_{tables_of(free), tables_of(wall)} {}

void AdvectionKernel::operator()(const std::vector<Field>& fields, const std::array<const double*, 3>& wind) const {
  HWY_DYNAMIC_DISPATCH(Advect)(d_, tables_, fields, wind);
}

scene::LegendrePoints mirrored(scene::LegendrePoints points) {
  const scene::LegendrePoints in_order = points;
  const Eigen::Index m = points.node.size(), half = (m + 1) / 2;
  for (Eigen::Index i = half; i < m; ++i) {
    const Eigen::Index from = m - 1 - (i - half);
    points.node[i] = in_order.node[from];
    points.weight[i] = in_order.weight[from];
    points.values.row(i) = in_order.values.row(from);
    points.slopes.row(i) = in_order.slopes.row(from);
    points.analysis.col(i) = in_order.analysis.col(from);
  }
  return points;
}

}  // namespace airlight::legendre_fluids
#endif
