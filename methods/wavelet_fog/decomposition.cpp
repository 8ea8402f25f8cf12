#include "methods/wavelet_fog/decomposition.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace airlight::wavelet_fog {
namespace {

using scene::IndexRange;

int floor_half(int i) { return i >= 0 ? i / 2 : -((1 - i) / 2); }

// Indices k that a filter reaches from [lo, lo + size).
std::pair<int, int> reached(int lo, int size, const Taps& taps) {
  const int length = int(taps.values.size());
  const int first = floor_half(lo - taps.first - length + 2);  // ceil((lo - taps.first - length + 1) / 2)
  return {first, floor_half(lo + size - 1 - taps.first) - first + 1};
}

// Along u of one row.
void row_down(const double* c, int lo, int size, const Taps& taps, int first, int count, double* out) {
  const int length = int(taps.values.size());
  for (int k = 0; k < count; ++k) {
    const int start = 2 * (first + k) + taps.first - lo;
    double sum = 0;
    for (int t = std::max(0, -start); t < length && start + t < size; ++t) sum += taps.values[t] * c[start + t];
    out[k] = sum;
  }
}

void row_up(const double* a, int lo, int size, const Taps& taps, int first, int count, double* out) {
  const int length = int(taps.values.size());
  for (int k = 0; k < size; ++k) {
    const int start = 2 * (lo + k) + taps.first - first;
    for (int t = std::max(0, -start); t < length && start + t < count; ++t) out[start + t] += taps.values[t] * a[k];
  }
}

}  // namespace

IndexRange coarse_range(const IndexRange& range, const Taps& along_u, const Taps& along_v) {
  const auto [u_first, u_count] = reached(range.lo[0], range.size[0], along_u);
  const auto [v_first, v_count] = reached(range.lo[1], range.size[1], along_v);
  return {{u_first, v_first}, {u_count, v_count}};
}

IndexRange fine_range(const IndexRange& coarse, const Taps& taps) {
  IndexRange fine;
  for (int a = 0; a < 2; ++a) {
    fine.lo[a] = 2 * coarse.lo[a] + taps.first;
    fine.size[a] = 2 * (coarse.size[a] - 1) + int(taps.values.size());
  }
  return fine;
}

IndexRange united(const IndexRange& x, const IndexRange& y) {
  IndexRange both;
  for (int a = 0; a < 2; ++a) {
    both.lo[a] = std::min(x.lo[a], y.lo[a]);
    both.size[a] = std::max(x.lo[a] + x.size[a], y.lo[a] + y.size[a]) - both.lo[a];
  }
  return both;
}

Coefficients filter_down(const Coefficients& c, const Taps& along_u, const Taps& along_v) {
  const IndexRange range = coarse_range(c.range, along_u, along_v);
  const int u_first = range.lo[0], u_count = range.size[0], v_first = range.lo[1], v_count = range.size[1];
  Coefficients out{range, std::vector<double>(std::size_t(u_count) * v_count)};
  // Rows are filtered along u when the filter along v needs them. The last taps + 1 rows are kept: row
  // `at` in rows[at % size].
  const int length = int(along_v.values.size());
  std::vector<std::vector<double>> rows(std::size_t(length) + 1, std::vector<double>(u_count));
  int made = c.range.lo[1];
  for (int k = 0; k < v_count; ++k) {
    const int start = 2 * (v_first + k) + along_v.first;
    double* to = out.values.data() + std::size_t(k) * u_count;
    for (int t = 0; t < length; ++t) {
      const int j = start + t, at = j - c.range.lo[1];
      if (at < 0 || at >= c.range.size[1]) continue;
      auto& row = rows[std::size_t(at) % rows.size()];
      if (j >= made) {
        row_down(c.values.data() + std::size_t(at) * c.range.size[0], c.range.lo[0], c.range.size[0], along_u, u_first,
                 u_count, row.data());
        made = j + 1;
      }
      for (int i = 0; i < u_count; ++i) to[i] += along_v.values[t] * row[i];
    }
  }
  return out;
}

void filter_up(const Coefficients& a, const Taps& along_u, const Taps& along_v, Coefficients& fine) {
  std::vector<double> row(fine.range.size[0]);
  for (int k = 0; k < a.range.size[1]; ++k) {
    std::fill(row.begin(), row.end(), 0.0);
    row_up(a.values.data() + std::size_t(k) * a.range.size[0], a.range.lo[0], a.range.size[0], along_u,
           fine.range.lo[0], fine.range.size[0], row.data());
    for (std::size_t t = 0; t < along_v.values.size(); ++t) {
      const int j = 2 * (a.range.lo[1] + k) + along_v.first + int(t) - fine.range.lo[1];
      if (j < 0 || j >= fine.range.size[1]) continue;
      double* to = fine.values.data() + std::size_t(j) * fine.range.size[0];
      for (int i = 0; i < fine.range.size[0]; ++i) to[i] += along_v.values[t] * row[i];
    }
  }
}

Bands split(const Coefficients& c, const Family& f) {
  return {filter_down(c, f.p_tilde, f.p_tilde), filter_down(c, f.p_tilde, f.q_tilde),
          filter_down(c, f.q_tilde, f.p_tilde), filter_down(c, f.q_tilde, f.q_tilde)};
}

Coefficients join(const Bands& bands, const Family& f, const IndexRange& range) {
  Coefficients c{range, std::vector<double>(std::size_t(range.size[0]) * range.size[1])};
  filter_up(bands.aa, f.p, f.p, c);
  filter_up(bands.ad, f.p, f.q, c);
  filter_up(bands.da, f.q, f.p, c);
  filter_up(bands.dd, f.q, f.q, c);
  return c;
}

Decomposition decompose(Coefficients c, const Family& f, int levels) {
  Decomposition d;
  for (int l = 0; l < levels; ++l) {
    d.ranges.push_back(c.range);
    d.levels.push_back(split(c, f));
    if (l + 1 < levels) c = std::exchange(d.levels.back().aa, Coefficients());
  }
  return d;
}

Coefficients reconstruct(const Decomposition& d, const Family& f) {
  Bands bands = d.levels.back();
  for (std::size_t l = d.levels.size(); l-- > 0;) {
    Coefficients c = join(bands, f, d.ranges[l]);
    if (l == 0) return c;
    bands = d.levels[l - 1];
    bands.aa = std::move(c);
  }
  return {};
}

std::vector<Coefficients> approximations(const Coefficients& c, const Taps& low, int levels) {
  std::vector<Coefficients> all{c};
  for (int l = 0; l < levels; ++l) all.push_back(filter_down(all.back(), low, low));
  return all;
}

Coefficients difference(const Coefficients& fine, const Coefficients& coarse, int degree) {
  const Taps p = two_scale(degree);
  Coefficients r;
  r.range = united(fine.range, fine_range(coarse.range, p));
  r.values.assign(std::size_t(r.range.size[0]) * r.range.size[1], 0);
  filter_up(coarse, p, p, r);
  for (double& value : r.values) value = -value;
  const int right = fine.range.lo[0] - r.range.lo[0], down = fine.range.lo[1] - r.range.lo[1];
  for (int j = 0; j < fine.range.size[1]; ++j)
    for (int i = 0; i < fine.range.size[0]; ++i)
      r.values[std::size_t(j + down) * r.range.size[0] + i + right] +=
          fine.values[std::size_t(j) * fine.range.size[0] + i];
  return r;
}

Coefficients clamped(Coefficients c) {
  const double before = std::accumulate(c.values.begin(), c.values.end(), 0.0);
  for (double& value : c.values) value = std::max(0.0, value);
  const double after = std::accumulate(c.values.begin(), c.values.end(), 0.0);
  if (after > 0)
    for (double& value : c.values) value *= std::max(0.0, before) / after;
  return c;
}

int most_levels(const IndexRange& range) {
  int levels = 0;
  for (int side = std::max(range.size[0], range.size[1]); side > 1; side /= 2) ++levels;
  return levels;
}

}  // namespace airlight::wavelet_fog
