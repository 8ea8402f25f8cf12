#include "methods/legendre_fluids/advection_kernel.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "methods/legendre_fluids/advection_kernel.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace airlight::legendre_fluids::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using Field = AdvectionKernel::Field;
using Tables = AdvectionKernel::Tables;
constexpr D d;
constexpr int block = 8, lanes = int(hn::MaxLanes(d)), vectors = block / lanes;
// So many rows at a time that their sums, even and odd, stay in registers.
constexpr int most_pairs = vectors == 1 ? 6 : vectors == 2 ? 3 : 1;

// Up to eight columns.
struct Lanes {
  explicit Lanes(int n) : count(n) {}
  HWY_INLINE V load(const double* from, int v) const {
    if (count == block) return hn::LoadU(d, from + v * lanes);
    const int here = count - v * lanes;
    return here > 0 ? hn::MaskedLoad(hn::FirstN(d, std::size_t(here)), d, from + v * lanes) : hn::Zero(d);
  }
  HWY_INLINE void store(V value, double* to, int v) const {
    if (count == block) return hn::StoreU(value, d, to + v * lanes);
    const int here = count - v * lanes;
    if (here > 0) hn::BlendedStore(value, hn::FirstN(d, std::size_t(here)), d, to + v * lanes);
  }
  int count;
};

// Rows of columns: row i begins at data + i * stride.
struct Rows {
  const double* data;
  std::ptrdiff_t stride;
};
struct RowsOut {
  double* data;
  std::ptrdiff_t stride;
};

// Of `P` points from the i-th on, and their mirror images.
template <int P>
HWY_INLINE void PointsOf(const double* matrix, int count, int even, const Rows& in, const RowsOut& out, int i, int half,
                         int points, const Lanes& l) {
  V e[P][vectors], o[P][vectors];
  for (int p = 0; p < P; ++p)
    for (int v = 0; v < vectors; ++v) e[p][v] = o[p][v] = hn::Zero(d);
  const double* rows = matrix + i * count;
  const auto add = [&](int k, V(&sum)[P][vectors]) HWY_ATTR {
    V b[vectors];
    for (int v = 0; v < vectors; ++v) b[v] = l.load(in.data + k * in.stride, v);
    for (int p = 0; p < P; ++p) {
      const V a = hn::Set(d, rows[p * count + k]);
      for (int v = 0; v < vectors; ++v) sum[p][v] = hn::MulAdd(a, b[v], sum[p][v]);
    }
  };
  int k = 0;
  if (even == 0) {
    for (; k + 1 < count; k += 2) add(k, e), add(k + 1, o);
    if (k < count) add(k, e);
  } else {
    for (; k + 1 < count; k += 2) add(k, o), add(k + 1, e);
    if (k < count) add(k, o);
  }
  for (int p = 0; p < P; ++p)
    for (int v = 0; v < vectors; ++v) {
      l.store(hn::Add(e[p][v], o[p][v]), out.data + (i + p) * out.stride, v);
      if (half + i + p < points) l.store(hn::Sub(e[p][v], o[p][v]), out.data + (half + i + p) * out.stride, v);
    }
}

// Coefficients to points.
HWY_INLINE void ToPoints(const Tables& t, bool slopes, const Rows& in, const RowsOut& out, const Lanes& l) {
  const double* matrix = slopes ? t.slopes.data() : t.values.data();
  const int even = slopes;  // the first of them that is
  int i = 0;
  for (; i + most_pairs <= t.half; i += most_pairs)
    PointsOf<most_pairs>(matrix, t.count, even, in, out, i, t.half, t.points, l);
  if (most_pairs > 3 && i + 3 <= t.half) {
    PointsOf<3>(matrix, t.count, even, in, out, i, t.half, t.points, l);
    i += 3;
  }
  for (; i < t.half; ++i) PointsOf<1>(matrix, t.count, even, in, out, i, t.half, t.points, l);
}

// Of P even and P odd functions; `sums` has those of mirror images in its first half, their differences in the second.
template <int P>
HWY_INLINE void FunctionsOf(const Tables& t, int first_even, int first_odd, const double* sums, const RowsOut& out,
                            const Lanes& l) {
  V e[P][vectors], o[P][vectors];
  for (int p = 0; p < P; ++p)
    for (int v = 0; v < vectors; ++v) e[p][v] = o[p][v] = hn::Zero(d);
  const double* even_rows = t.analysis.data() + std::ptrdiff_t(first_even) * t.half;
  const double* odd_rows = t.analysis.data() + std::ptrdiff_t(first_odd) * t.half;
  for (int i = 0; i < t.half; ++i) {
    V s[vectors], r[vectors];
    for (int v = 0; v < vectors; ++v) {
      s[v] = hn::LoadU(d, sums + i * block + v * lanes);
      r[v] = hn::LoadU(d, sums + (t.half + i) * block + v * lanes);
    }
    for (int p = 0; p < P; ++p) {
      const V a = hn::Set(d, even_rows[2 * p * t.half + i]), b = hn::Set(d, odd_rows[2 * p * t.half + i]);
      for (int v = 0; v < vectors; ++v) {
        e[p][v] = hn::MulAdd(a, s[v], e[p][v]);
        o[p][v] = hn::MulAdd(b, r[v], o[p][v]);
      }
    }
  }
  for (int p = 0; p < P; ++p)
    for (int v = 0; v < vectors; ++v) {
      if (first_even + 2 * p < t.count) l.store(e[p][v], out.data + (first_even + 2 * p) * out.stride, v);
      if (first_odd + 2 * p < t.count) l.store(o[p][v], out.data + (first_odd + 2 * p) * out.stride, v);
    }
}

// Points to coefficients: `sums` as above. The matrix has a row of zeros behind its last.
HWY_INLINE void ToFunctions(const Tables& t, const double* sums, const RowsOut& out, const Lanes& l) {
  const int pairs = (t.count + 1) / 2;
  int p = 0;
  for (; p + most_pairs <= pairs; p += most_pairs) FunctionsOf<most_pairs>(t, 2 * p, 2 * p + 1, sums, out, l);
  if (most_pairs > 2 && p + 2 <= pairs) {
    FunctionsOf<2>(t, 2 * p, 2 * p + 1, sums, out, l);
    p += 2;
  }
  for (; p < pairs; ++p) FunctionsOf<1>(t, 2 * p, 2 * p + 1, sums, out, l);
}

// out[o][0 .. to) = sum over k of in[o][k] matrix[k][...], whose rows are filled up to eights.
template <int R>
HWY_INLINE void RowsOf(const double* matrix, int padded, int from, int to, const double* in, double* out) {
  for (int c = 0; c < to; c += block) {
    V sum[R][vectors];
    for (int r = 0; r < R; ++r)
      for (int v = 0; v < vectors; ++v) sum[r][v] = hn::Zero(d);
    for (int k = 0; k < from; ++k) {
      V b[vectors];
      for (int v = 0; v < vectors; ++v) b[v] = hn::LoadU(d, matrix + k * padded + c + v * lanes);
      for (int r = 0; r < R; ++r) {
        const V a = hn::Set(d, in[r * from + k]);
        for (int v = 0; v < vectors; ++v) sum[r][v] = hn::MulAdd(a, b[v], sum[r][v]);
      }
    }
    const Lanes l(std::min(block, to - c));
    for (int r = 0; r < R; ++r)
      for (int v = 0; v < vectors; ++v) l.store(sum[r][v], out + r * to + c, v);
  }
}
HWY_INLINE void AlongLast(const std::vector<double>& matrix, int from, int to, int rows, const double* in,
                          double* out) {
  constexpr int many = vectors == 1 ? 8 : 4;
  const int padded = (to + block - 1) / block * block;
  int o = 0;
  for (; o + many <= rows; o += many)
    RowsOf<many>(matrix.data(), padded, from, to, in + std::ptrdiff_t(o) * from, out + std::ptrdiff_t(o) * to);
  for (; o < rows; ++o)
    RowsOf<1>(matrix.data(), padded, from, to, in + std::ptrdiff_t(o) * from, out + std::ptrdiff_t(o) * to);
}

// Sums and differences of mirror images, of eight columns.
HWY_INLINE void Fold(const Tables& t, const Rows& in, double* sums, const Lanes& l) {
  for (int i = 0; i < t.half; ++i)
    for (int v = 0; v < vectors; ++v) {
      const V a = l.load(in.data + i * in.stride, v);
      const bool pair = t.half + i < t.points;
      const V b = pair ? l.load(in.data + (t.half + i) * in.stride, v) : hn::Zero(d);
      hn::StoreU(hn::Add(a, b), d, sums + i * block + v * lanes);
      hn::StoreU(pair ? hn::Sub(a, b) : b, d, sums + (t.half + i) * block + v * lanes);
    }
}

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
            if (wind[a]) w = hn::Add(w, l.load(wind[a] + std::ptrdiff_t(i) * q_ + at, v));
            sum = hn::NegMulAdd(w, hn::LoadU(d, scratch(f, a) + i * block + v * lanes), sum);
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
