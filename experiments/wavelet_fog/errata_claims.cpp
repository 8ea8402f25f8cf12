// Errata of Giroud and Biri 2010 in its text and its pseudo code: what they say, measured.
#include <algorithm>

#include "experiments/wavelet_fog/errata_setup.h"
#include "methods/wavelet_fog/band_grid.h"
#include "methods/wavelet_fog/compression.h"

namespace airlight::experiments::errata {

using fog::Coefficients;
using scene::MapLine;

double relative(const Coefficients& a, const Coefficients& b, int degree) {
  Coefficients off = a;
  for (std::size_t i = 0; i < off.values.size(); ++i) off.values[i] -= b.values[i];
  return fog::l2_norm(off, degree) / fog::l2_norm(b, degree);
}

// Eq. 7 makes F_J the union of F_0 and all G_j, where it is their direct sum: relative L2 error of K as the member of the union that comes
// closest, of the parts that Mallat's algorithm takes to them, and as the sum of all.
Figures union_of_spaces(const Setup& s) {
  const int levels = s.levels.count(), degree = s.rays.map.degree();
  const fog::Decomposition whole = decompose(s.map, s.family, levels);
  double closest = infinity;
  for (int space = 0; space <= levels; ++space) {  // the last: F_0
    fog::Decomposition d = whole;
    for (int l = 0; l < levels; ++l) {
      fog::Bands& bands = d.levels[l];
      for (Coefficients* band : {&bands.ad, &bands.da, &bands.dd})
        if (l != space) std::fill(band->values.begin(), band->values.end(), 0.0);
    }
    if (space != levels) std::fill(d.levels.back().aa.values.begin(), d.levels.back().aa.values.end(), 0.0);
    closest = std::min(closest, relative(reconstruct(d, s.family), s.map, degree));
  }
  return {closest, relative(reconstruct(whole, s.family), s.map, degree)};
}

// Eq. 3 integrates the fog's light from 0, a place as P is, where it is O: rms error of that light, L_fog = 0.8, with the map's corner as 0.
Figures from_zero(const Setup& s) {
  constexpr double white = 0.8;
  return {s.rms([&](std::size_t i) {
            const MapLine& line = s.rays.lines[i];
            const double u = line.u + s.rays.lengths[i] * line.du, v = line.v + s.rays.lengths[i] * line.dv;
            const double length = std::hypot(u, v);
            const MapLine from{0, 0, 0, u / length, v / length, 0};
            const double depth = s.rays.sigma * scene::integral(s.rays.map, same, from, {0, length});
            return white * (std::expm1(-s.depth(i)) - std::expm1(-depth));
          }),
          0};
}

// Algorithm 1 walks while pos != exit, from intersection to intersection with the grid: share of the rays that leave the map by its rim,
// where the exit is such an intersection, and yet is passed by in single precision, so that the loop does not end. By distance: none.
Figures exit_by_equality(const Setup& s) {
  long passing = 0, leaving = 0;
  for (std::size_t i = 0; i < s.rays.lines.size(); ++i) {
    const MapLine& line = s.rays.lines[i];
    const Interval t = scene::clip(s.rays.map, line, {0, s.rays.lengths[i]});
    if (t.empty() || t.hi == s.rays.lengths[i]) continue;
    ++leaving;
    const float along[2] = {float(line.du), float(line.dv)};
    float pos[2] = {float(line.u + t.lo * line.du), float(line.v + t.lo * line.dv)};
    const float exit[2] = {float(line.u + t.hi * line.du), float(line.v + t.hi * line.dv)};
    const auto behind = [&](int a) { return (pos[a] - exit[a]) * along[a] > 1; };
    while (!(pos[0] == exit[0] && pos[1] == exit[1]) && !behind(0) && !behind(1)) {
      float step = float(infinity);
      for (int a = 0; a < 2; ++a) {
        if (along[a] == 0) continue;
        const float next = along[a] > 0 ? std::floor(pos[a]) + 1 : std::ceil(pos[a]) - 1;
        step = std::min(step, (next - pos[a]) / along[a]);
      }
      for (int a = 0; a < 2; ++a) pos[a] += step * along[a];
    }
    passing += behind(0) || behind(1) ? 1 : 0;
  }
  return {double(passing) / double(leaving), 0};
}

// Algorithm 1 adds all details wherever they are and never uses Eq. 12's distance: coefficients a ray, and with mu = 0.6.
Figures no_distance(const Setup& s) {
  fog::Visits all, some;
  for (std::size_t i = 0; i < s.rays.lines.size(); ++i) {
    const MapLine& line = s.rays.lines[i];
    const double length = fog::length_in_box(s.levels, line, s.rays.lengths[i]);
    fog::summed_depth(s.levels, same, line, {0, infinity}, length, 1, all);
    fog::summed_depth(s.levels, same, line, {0, infinity}, length, 0.6, some);
  }
  const double rays = double(s.rays.lines.size());
  return {double(all.coefficients) / rays, double(some.coefficients) / rays};
}

// Nor does it use the threshold of opacity that section 4.3 ends rays by: cells of the map a ray, and until the threshold.
Figures no_threshold(const Setup& s) {
  long all = 0, until = 0;
  for (std::size_t i = 0; i < s.rays.lines.size(); ++i) {
    double sum = 0;
    walk_cells(s.rays.map, s.rays.lines[i], {0, s.rays.lengths[i]}, [&](int, int, double from, double to) {
      ++all;
      until += std::exp(-sum) > s.threshold ? 1 : 0;
      sum += s.rays.sigma * scene::integral(s.rays.map, same, s.rays.lines[i], {from, to});
      return false;
    });
  }
  const double rays = double(s.rays.lines.size());
  return {double(all) / rays, double(until) / rays};
}

// "A precise numerical integration, without any approximation": rms error of the transmittance by tables of integrals between places on a
// cell's perimeter, the nearest of them (section 4.2), and by Gauss points.
Figures tabulated(const Setup& s) {
  const fog::BandGrid grid(s.rays.map, 0);
  const fog::PathTable table(grid.pieces(), s.places, fog::PathTable::Lookup::nearest);
  const auto error = [&](const fog::PathTable* by) {
    return s.rms([&](std::size_t i) {
      fog::Visits visits;
      const double sum = grid.integral(same, s.rays.lines[i], {0, s.rays.lengths[i]}, by, visits);
      return std::exp(-s.rays.sigma * sum) - std::exp(-s.depth(i));
    });
  };
  return {error(&table), error(nullptr)};
}

// "The scaling function must tend to zero on both sides of its support", and Haar, which does not, is used: greatest step of K where two
// cells meet, as a share of the greatest coefficient; as the rule wants it (the map's own splines) and with Haar.
Figures haar_steps(const Setup& s) {
  const scene::IndexRange& range = s.map.range;
  const double most = *std::max_element(s.map.values.begin(), s.map.values.end());
  const auto step = [&](int degree) {
    constexpr double beside = 1e-12;
    const scene::SplineMap map(degree, range, s.map.values);
    double greatest = 0;
    for (int j = 0; j < range.size[1] + degree; ++j)
      for (int i = 0; i <= range.size[0] + degree; ++i) {
        const double u = range.lo[0] + i, v = range.lo[1] + j + 0.5;
        greatest = std::max(greatest, std::abs(map.at(u + beside, v) - map.at(u - beside, v)));
      }
    return greatest / most;
  };
  return {step(s.rays.map.degree()), step(0)};
}

}  // namespace airlight::experiments::errata
