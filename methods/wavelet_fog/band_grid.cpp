#include "methods/wavelet_fog/band_grid.h"

#include <algorithm>
#include <climits>
#include <cmath>

#include "scene/media/spline_integral.h"

namespace airlight::wavelet_fog {
namespace {

using scene::HeightProfile;
using scene::MapLine;

constexpr int most_pieces = 16;  // of one family: 3 + 5 for CDF 3.3

Coefficients coefficients_of(const scene::SplineMap& map) { return {map.range(), map.coefficients()}; }

}  // namespace

BandGrid::BandGrid(const scene::SplineMap& map, int level) : pieces_{map.degree(), {}}, level_(level) {
  add_band(coefficients_of(map), false, false);
  lay_cells();
}

BandGrid::BandGrid(const Bands& bands, const Family& family, int level)
    : pieces_{family.degree, family.q}, level_(level) {
  add_band(bands.ad, false, true);
  add_band(bands.da, true, false);
  add_band(bands.dd, true, true);
  lay_cells();
}

void BandGrid::add_band(const Coefficients& c, bool wavelet_u, bool wavelet_v) {
  Band band{wavelet_u, wavelet_v, c, {}, {}};
  for (int a = 0; a < 2; ++a) {
    const bool wavelet = a == 0 ? wavelet_u : wavelet_v;
    band.reach[a] = wavelet ? pieces_.wavelet() : pieces_.scaling();
    band.first[a] = wavelet ? pieces_.wavelet_first() : 0;
  }
  per_cell_ += band.reach[0] * band.reach[1];
  bands_.push_back(std::move(band));
}

// The cells that any band reaches.
void BandGrid::lay_cells() {
  scene::IndexRange range;
  for (int a = 0; a < 2; ++a) {
    int lo = INT_MAX, hi = INT_MIN;
    for (const Band& b : bands_) {
      lo = std::min(lo, b.coefficients.range.lo[a] + b.first[a]);
      hi = std::max(hi, b.coefficients.range.lo[a] + b.coefficients.range.size[a] - 1 + b.first[a] + b.reach[a]);
    }
    range.lo[a] = lo;
    range.size[a] = hi - lo;
  }
  cells_ = scene::SplineMap(0, range, std::vector<double>(std::size_t(range.size[0]) * range.size[1]));
}

double BandGrid::coefficient(const Band& b, int i, int j) const {
  const scene::IndexRange& range = b.coefficients.range;
  const int x = i - range.lo[0], y = j - range.lo[1];
  if (x < 0 || y < 0 || x >= range.size[0] || y >= range.size[1]) return 0;
  return b.coefficients.values[std::size_t(y) * range.size[0] + x];
}

double BandGrid::in_cell(int i, int j, double u, double v) const {
  double along_u[most_pieces], along_v[most_pieces];
  pieces_.at(u, along_u);
  pieces_.at(v, along_v);
  double sum = 0;
  for (const Band& band : bands_) {
    const double* a = along_u + (band.wavelet_u ? pieces_.scaling() : 0);
    const double* b = along_v + (band.wavelet_v ? pieces_.scaling() : 0);
    for (int k = 0; k < band.reach[1]; ++k)
      for (int m = 0; m < band.reach[0]; ++m)
        sum += a[m] * b[k] * coefficient(band, i - band.first[0] - m, j - band.first[1] - k);
  }
  return sum;
}

// factor: at the entry, and what it gains until the exit.
double BandGrid::looked_up(int i, int j, double entry, double exit, const double (&factor)[2],
                           const PathTable& table) const {
  double integrals[2 * most_pieces * most_pieces];
  table.integrals(entry, exit, integrals);
  const int count = table.pieces();
  if (table.moments())
    for (int k = 0; k < count * count; ++k)
      integrals[k] = factor[0] * integrals[k] + factor[1] * integrals[count * count + k];
  double sum = 0;
  for (const Band& band : bands_) {
    const int a = band.wavelet_u ? pieces_.scaling() : 0, b = band.wavelet_v ? pieces_.scaling() : 0;
    for (int k = 0; k < band.reach[1]; ++k)
      for (int m = 0; m < band.reach[0]; ++m)
        sum += integrals[(a + m) * count + b + k] * coefficient(band, i - band.first[0] - m, j - band.first[1] - k);
  }
  return sum;
}

// By Gauss points between half cells and breaks of the height's factor, in pieces of at most one scale height.
double BandGrid::walked(const HeightProfile& profile, const MapLine& line, int i, int j, Interval t) const {
  std::vector<double> cuts{t.lo, t.hi};
  const auto cut = [&](double at, double start, double step) {
    if (const double where = (at - start) / step; step != 0 && where > t.lo && where < t.hi) cuts.push_back(where);
  };
  if (!pieces_.q.values.empty()) {
    cut(i + 0.5, line.u, line.du);
    cut(j + 0.5, line.v, line.dv);
  }
  for (const double height : height_breaks(profile)) cut(height, line.y, line.dy);
  std::sort(cuts.begin(), cuts.end());
  const auto* fall = std::get_if<scene::ExponentialFall>(&profile);
  const int points = pieces_.degree + (fall ? 6 : 1);
  const scene::spline_integral::UnitRule& rule = scene::spline_integral::unit_rule(points);
  double sum = 0;
  for (std::size_t c = 0; c + 1 < cuts.size(); ++c) {
    const double length = cuts[c + 1] - cuts[c];
    const double parts = fall ? std::max(1.0, std::ceil(std::abs(line.dy) * length / fall->scale_height)) : 1;
    for (double part = 0; part < parts; ++part)
      for (int k = 0; k < points; ++k) {
        const double at = cuts[c] + (part + rule.node[k]) / parts * length;
        sum += length / parts * rule.weight[k] * factor_at(profile, line.y + at * line.dy) *
               in_cell(i, j, line.u + at * line.du - i, line.v + at * line.dv - j);
      }
  }
  return sum;
}

namespace {

// The factor of the height as a straight line over t: at its beginning, and what it gains. Nothing where it breaks, or falls too much.
bool straight(const HeightProfile& profile, const MapLine& line, Interval t, double (&factor)[2]) {
  factor[0] = 1;
  factor[1] = 0;
  if (std::holds_alternative<scene::SameAtAllHeights>(profile)) return true;
  const double a = line.y + t.lo * line.dy, b = line.y + t.hi * line.dy;
  for (const double height : height_breaks(profile))
    if (height > std::min(a, b) && height < std::max(a, b)) return false;
  if (const auto* fall = std::get_if<scene::ExponentialFall>(&profile);
      fall && std::abs(b - a) > BandGrid::most_fall * fall->scale_height && std::max(a, b) > fall->base)
    return false;
  const double off = 0.5 / std::sqrt(3.0), middle = 0.5 * (a + b);  // two Gauss points
  const double first = factor_at(profile, middle - off * (b - a)), second = factor_at(profile, middle + off * (b - a));
  factor[1] = (second - first) / (2 * off);
  factor[0] = 0.5 * (first + second - factor[1]);
  return true;
}

}  // namespace

double BandGrid::integral(const HeightProfile& profile, const MapLine& line, Interval t, const PathTable* table,
                          Visits& visits) const {
  const MapLine here = coarser(line, level_);
  const double across = std::hypot(here.du, here.dv);  // cells per unit of t
  constexpr double on_line = 1e-9;
  const auto on_perimeter = [&](double u, double v) {
    return std::min({std::abs(u), std::abs(1 - u), std::abs(v), std::abs(1 - v)}) < on_line;
  };
  t = clip(cells_, here, t);
  if (!t.empty() && std::isinf(t.hi)) {  // upright: as far as there is anything
    const Interval heights = occupied_heights(profile);
    t.hi = here.dy == 0 ? infinity : ((here.dy > 0 ? heights.hi : heights.lo) - here.y) / here.dy;
    const double i = std::floor(here.u), j = std::floor(here.v);
    if (std::isinf(t.hi)) return in_cell(int(i), int(j), here.u - i, here.v - j) > 0 ? infinity : 0;
  }
  double sum = 0;
  walk_cells(cells_, here, t, [&](int i, int j, double from, double to) {
    ++visits.cells;
    visits.coefficients += per_cell_;
    const double u = here.u + from * here.du - i, v = here.v + from * here.dv - j;
    const double u1 = here.u + to * here.du - i, v1 = here.v + to * here.dv - j;
    double factor[2];
    // A way that is only rounding is no look-up: a bilinear one finds a length between its places.
    if (table && (to - from) * across > on_line && on_perimeter(u, v) && on_perimeter(u1, v1) &&
        straight(profile, here, {from, to}, factor))
      sum += looked_up(i, j, PathTable::place(u, v), PathTable::place(u1, v1), factor, *table) / across;
    else
      sum += walked(profile, here, i, j, {from, to});
    return false;
  });
  return sum;
}

}  // namespace airlight::wavelet_fog
