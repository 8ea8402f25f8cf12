// Transforms of eight columns at a time, to the points of an axis and back, on vectors. Included once per instruction set (the guard is
// Highway's).
#if defined(AIRLIGHT_LEGENDRE_FLUIDS_COLUMNS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef AIRLIGHT_LEGENDRE_FLUIDS_COLUMNS_INL_H_
#undef AIRLIGHT_LEGENDRE_FLUIDS_COLUMNS_INL_H_
#else
#define AIRLIGHT_LEGENDRE_FLUIDS_COLUMNS_INL_H_
#endif

#include <hwy/highway.h>

#include "methods/legendre_fluids/advection_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace airlight::legendre_fluids::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
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

// Values at `P` points from the i-th on, and at their mirror images.
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
      for (int v = 0; v < vectors; ++v) sum[p][v] = MulAdd(a, b[v], sum[p][v]);
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
      l.store(e[p][v] + o[p][v], out.data + (i + p) * out.stride, v);
      if (half + i + p < points) l.store(e[p][v] - o[p][v], out.data + (half + i + p) * out.stride, v);
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

// Coefficients of P even and P odd functions. `sums`: sums of mirror images in the first half, their
// differences in the second.
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
        e[p][v] = MulAdd(a, s[v], e[p][v]);
        o[p][v] = MulAdd(b, r[v], o[p][v]);
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
        for (int v = 0; v < vectors; ++v) sum[r][v] = MulAdd(a, b[v], sum[r][v]);
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
      hn::StoreU(a + b, d, sums + i * block + v * lanes);
      hn::StoreU(pair ? a - b : b, d, sums + (t.half + i) * block + v * lanes);
    }
}

}  // namespace airlight::legendre_fluids::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
