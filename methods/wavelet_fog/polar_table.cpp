#include "methods/wavelet_fog/polar_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "methods/wavelet_fog/interpolation.h"
#include "scene/base/error.h"
#include "scene/media/spline_integral.h"

namespace airlight::wavelet_fog {
namespace {

using scene::MapLine;
using scene::SplineMap;

// Distance of a point from the farthest corner of the support [cells].
double farthest(const SplineMap& map, double u, double v) {
  const double x = std::max(std::abs(map.support_lo(0) - u), std::abs(map.support_hi(0) - u));
  const double y = std::max(std::abs(map.support_lo(1) - v), std::abs(map.support_hi(1) - v));
  return std::hypot(x, y);
}

// Adds the integrals of f and s f over [from, to] in a cell, by n + 1 Gauss points: exact for s f, of degree 2 n + 1.
template <int n, class Entry>
void add_piece(const SplineMap& map, const MapLine& line, int i, int j, double from, double to, Entry& sum) {
  const auto& rule = scene::spline_integral::unit_rule(n + 1);
  for (int k = 0; k <= n; ++k) {
    const double s = from + rule.node[k] * (to - from);
    const double f = (to - from) * rule.weight[k] *
                     scene::spline_integral::in_cell<n>(map.cell(i, j), map.stride(), line.u + s * line.du - i,
                                                        line.v + s * line.dv - j);
    sum.f += f;
    sum.s_f += s * f;
  }
}

// Distance of the point (u, v) from the support of the map [cells]; 0 within it.
double nearest(const SplineMap& map, double u, double v) {
  const double x = std::max({0.0, map.support_lo(0) - u, u - map.support_hi(0)});
  const double y = std::max({0.0, map.support_lo(1) - v, v - map.support_hi(1)});
  return std::hypot(x, y);
}

// The entries of a spoke, in one walk. Returns the pieces of cells that were visited.
template <int n, class Entry>
long fill_spoke(const SplineMap& map, const MapLine& line, double step, int first, int steps, Entry* entry) {
  Entry sum{0, 0, 0};
  int next = first;
  const auto close = [&](double upto) {  // entries up to a distance
    for (; next <= first + steps && next * step <= upto; ++next) {
      sum.value = map.at(line.u + next * step * line.du, line.v + next * step * line.dv);
      entry[next - first] = sum;
    }
  };
  long pieces = 0;
  close(first * step);
  walk_cells(map, line, {first * step, (first + steps) * step}, [&](int i, int j, double from, double to) {
    close(from);
    while (from < to) {
      const double upto = std::min(to, next * step);
      add_piece<n>(map, line, i, j, from, upto, sum);
      ++pieces;
      close(upto);
      from = upto;
    }
    return false;
  });
  close(infinity);
  return pieces;
}

}  // namespace

namespace {

PolarTable::Fan whole_fan(const scene::Fogmap& fog, const scene::View& view) {
  const PolarTable::Fan all{0, 2 * pi};
  const auto azimuth = [&](const Vec3& direction) {
    const scene::MapLine line = line_over(fog, {view.camera.position, direction});
    return std::atan2(line.dv, line.du);
  };
  const auto ray = [&](double x, double y) {
    return scene::camera_ray(view.camera, x, y, view.width, view.height).direction;
  };
  const Vec3& forward = view.camera.forward;
  if (std::hypot(forward[0], forward[2]) < 1e-6) return all;
  const double middle = azimuth(forward);
  double least = 0, most = 0, before = 0;
  bool first = true, around = false;
  const auto look = [&](double x, double y) {
    double turn = std::remainder(azimuth(ray(x, y)) - middle, 2 * pi);
    around = around || (!first && std::abs(turn - before) > 0.5 * pi);  // the rim runs around a pole
    first = false;
    before = turn;
    least = std::min(least, turn);
    most = std::max(most, turn);
  };
  for (int x = 0; x <= view.width; ++x) look(x, 0);
  for (int y = 0; y <= view.height; ++y) look(view.width, y);
  for (int x = view.width; x >= 0; --x) look(x, view.height);
  for (int y = view.height; y >= 0; --y) look(0, y);
  constexpr double margin = 1e-6;
  return around || most - least > 1.9 * pi ? all : PolarTable::Fan{middle + least - margin, most - least + 2 * margin};
}

}  // namespace

PolarTable::Fan fan_of(const scene::Fogmap& fog, const scene::View& view, int angles) {
  const PolarTable::Fan seen = whole_fan(fog, view);
  const scene::MapLine eye = line_over(fog, {view.camera.position, Vec3::UnitX()});
  const SplineMap& map = fog.map;
  if (nearest(map, eye.u, eye.v) == 0) return seen;
  const auto turn_to = [&](double u, double v) {
    const double middle = seen.first + 0.5 * seen.span;
    return std::remainder(std::atan2(v - eye.v, u - eye.u) - middle, 2 * pi);
  };
  const double u[2] = {map.support_lo(0), map.support_hi(0)}, v[2] = {map.support_lo(1), map.support_hi(1)};
  const double to_map = turn_to(0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
  double least = 0, most = 0;  // from there
  for (const double x : u)
    for (const double y : v) {
      const double turn = std::remainder(turn_to(x, y) - to_map, 2 * pi);
      least = std::min(least, turn);
      most = std::max(most, turn);
    }
  // Spokes beside the map hold zeros, for rays that pass it by.
  const double spare = 6 * (most - least) / angles;
  const double lo = to_map + least - spare, hi = to_map + most + spare, half = 0.5 * seen.span;
  if (seen.span == 2 * pi) return {seen.first + half + lo, hi - lo};
  if (lo > half || hi < -half || hi > pi || lo < -pi) return seen;  // out of view, or behind the eye
  const double from = std::max(lo, -half), to = std::min(hi, half);
  return {seen.first + half + from, to - from};
}

Spoke spoke_of(const SplineMap& map, double u, double v, int angles, double step) {
  const double first = std::max(0.0, std::floor(nearest(map, u, v) / step) - 1);
  const double steps = std::ceil(farthest(map, u, v) / step) + 1 - first;
  constexpr double bytes = 24;
  if (!(bytes * steps * angles <= most_table_bytes) || !(first + steps < std::numeric_limits<int>::max()))
    throw Error(fmt::format(
        "variant = polar: a table of {} angles and {:.3g} distances takes {:.3g} GB, expected at most {:g}: "
        "fewer `angles`, a longer `radial_step`, or variant = skip",
        angles, steps, 1e-9 * bytes * steps * angles, 1e-9 * most_table_bytes));
  return {int(first), int(steps)};
}

PolarTable::PolarTable(const SplineMap& map, double u, double v, const Fan& fan, int angles, double step,
                       bool with_first_moment, const scene::Execution& execution)
    : fan_(fan),
      angles_(angles + 3),
      spacing_(fan.span / angles),
      step_(step),
      per_spacing_(1 / spacing_),
      per_step_(1 / step),
      first_moment_(with_first_moment) {
  const Spoke all = spoke_of(map, u, v, angles_, step);
  first_ = all.first;
  steps_ = all.steps;
  entries_.resize(std::size_t(angles_) * (steps_ + 1));
  std::mutex mutex;
  scene::parallel_for(angles_, execution, [&](int i) {
    Entry* spoke = entries_.data() + std::size_t(i) * (steps_ + 1);
    const double angle = fan_.first + (i - 1) * spacing_;
    const MapLine line{u, v, 0, std::cos(angle), std::sin(angle), 1};
    const long cells = scene::with_degree(
        map.degree(), [&](auto n) { return fill_spoke<n()>(map, line, step, first_, steps_, spoke); });
    const std::lock_guard lock(mutex);
    cells_ += cells;
  });
}

PolarTable::Place PolarTable::place(double du, double dv) const {
  double angle = std::atan2(dv, du) - fan_.first;
  while (angle < 0) angle += 2 * pi;
  while (angle >= 2 * pi) angle -= 2 * pi;
  const double place = angle * per_spacing_ + 1;
  const int i = std::min(int(place), angles_ - 2);
  return {i - 1, place - i};
}

PolarTable::Moments PolarTable::at(const Place& place, double r) const {
  const double along = std::clamp(r * per_step_ - first_, 0.0, double(steps_));
  const int k = std::min(int(along), steps_ - 1);
  const double t = along - k, w = 1 - t;
  // Hermite: values and slopes at both ends.
  const double a0 = w * w * (1 + 2 * t), a1 = w * w * t * step_, b0 = t * t * (1 + 2 * w), b1 = -t * t * w * step_;
  const double a2 = a1 * step_ * (first_ + k),
               b2 = b1 * step_ * (first_ + k + 1);  // the slope of s f is s times that of f
  double f[4], s_f[4];
  for (int n = 0; n < 4; ++n) {
    const Entry* entry = entries_.data() + std::size_t(std::min(place.first + n, angles_ - 1)) * (steps_ + 1);
    const Entry &a = entry[k], &b = entry[k + 1];
    f[n] = a0 * a.f + a1 * a.value + b0 * b.f + b1 * b.value;
    if (first_moment_) s_f[n] = a0 * a.s_f + a2 * a.value + b0 * b.s_f + b2 * b.value;
  }
  return {catmull_rom(place.t, f), first_moment_ ? catmull_rom(place.t, s_f) : 0};
}

}  // namespace airlight::wavelet_fog
