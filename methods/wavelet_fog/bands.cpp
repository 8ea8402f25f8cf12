#include "methods/wavelet_fog/bands.h"

#include <array>
#include <cmath>

#include "scene/media/spline_integral.h"

namespace airlight::wavelet_fog {
namespace {

int floor_half(int i) { return i >= 0 ? i / 2 : -((1 - i) / 2); }

// Values at a point of all functions sum_t taps_t N_n(u - 2k - t) that are not 0 there.
struct Weights {
  int first = 0, count = 0;
  std::array<double, 8> value{};
};

// u in fine cells.
Weights weights(const Taps& taps, int n, int cell, double u) {
  return scene::with_degree(n, [&](auto degree) {
    double basis[degree() + 1];
    scene::cell_basis<degree()>(u - cell, basis);
    const int length = int(taps.values.size());
    Weights w;
    w.first = floor_half(cell - n - taps.first - length + 2);
    w.count = floor_half(cell - taps.first) - w.first + 1;
    for (int k = 0; k < w.count; ++k)
      for (int m = 0; m <= n; ++m) {
        const int t = cell - m - 2 * (w.first + k) - taps.first;
        if (t >= 0 && t < length) w.value[k] += basis[m] * taps.values[t];
      }
    return w;
  });
}

double product(const Coefficients& c, const Weights& u, const Weights& v) {
  double sum = 0;
  for (int b = 0; b < v.count; ++b) {
    const int j = v.first + b - c.range.lo[1];
    if (j < 0 || j >= c.range.size[1]) continue;
    double row = 0;
    for (int a = 0; a < u.count; ++a) {
      const int i = u.first + a - c.range.lo[0];
      if (i >= 0 && i < c.range.size[0]) row += u.value[a] * c.values[std::size_t(j) * c.range.size[0] + i];
    }
    sum += v.value[b] * row;
  }
  return sum;
}

}  // namespace

double integral_of_bands(const scene::SplineMap& fine, const Bands& bands, const Family& f, int level,
                         const scene::HeightProfile& profile, const scene::MapLine& along, Interval t, Visits& visits) {
  const scene::MapLine line = coarser(along, level);
  const int n = f.degree, wide = (int(f.q.values.size()) + n) / 2;
  const auto& rule = scene::spline_integral::unit_rule(n + 1);
  double sum = 0;
  int last[2] = {0, 0};
  bool first = true;
  scene::spline_integral::between_breaks(profile, line, clip(fine, line, t), [&](Interval part) {
    walk_cells(fine, line, part, [&](int i, int j, double from, double to) {
      const int here[2] = {floor_half(i), floor_half(j)};
      if (first || here[0] != last[0] || here[1] != last[1]) {
        ++visits.cells;
        visits.coefficients += 2 * (n + 1) * wide + wide * wide;
        std::copy_n(here, 2, last);
        first = false;
      }
      for (int k = 0; k <= n; ++k) {
        const double at = from + rule.node[k] * (to - from), u = line.u + at * line.du, v = line.v + at * line.dv;
        const Weights phi_u = weights(f.p, n, i, u), psi_u = weights(f.q, n, i, u);
        const Weights phi_v = weights(f.p, n, j, v), psi_v = weights(f.q, n, j, v);
        sum += (to - from) * rule.weight[k] * factor_at(profile, line.y + at * line.dy) *
               (product(bands.ad, phi_u, psi_v) + product(bands.da, psi_u, phi_v) + product(bands.dd, psi_u, psi_v));
      }
      return false;
    });
  });
  return sum;
}

double banded_depth(const Levels& levels, const Decomposition& d, const Family& f, const scene::HeightProfile& profile,
                    const scene::MapLine& line, Interval inside, double length, double mu, Visits& visits) {
  const int L = levels.count();
  double sum = integral_of_level(levels.grid[L], L, profile, line, intersect(inside, {0, length}), visits);
  for (int m = 1; m <= L; ++m)
    sum += integral_of_bands(levels.detail[L - m], d.levels[L - m], f, L - m, profile, line,
                             intersect(inside, {0, reach_of(m, length, mu)}), visits);
  return sum;
}

}  // namespace airlight::wavelet_fog
