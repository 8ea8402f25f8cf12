#include "methods/wavelet_fog/polar_table.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "methods/wavelet_fog/interpolation.h"

namespace airlight::wavelet_fog {
namespace {

using scene::MapLine;
using scene::SplineMap;

// Of a point to the farthest corner of the support [cells].
double farthest(const SplineMap& map, double u, double v) {
  const double x = std::max(std::abs(map.support_lo(0) - u), std::abs(map.support_hi(0) - u));
  const double y = std::max(std::abs(map.support_lo(1) - v), std::abs(map.support_hi(1) - v));
  return std::hypot(x, y);
}

}  // namespace

PolarTable::Fan fan_of(const scene::Fogmap& fog, const scene::View& view) {
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

int steps_to_rim(const SplineMap& map, double u, double v, double step) {
  return int(std::ceil(farthest(map, u, v) / step)) + 1;
}

PolarTable::PolarTable(const SplineMap& map, double u, double v, const Fan& fan, int angles, double step,
                       bool with_first_moment, const scene::Execution& execution)
    : fan_(fan),
      angles_(angles + 3),
      steps_(steps_to_rim(map, u, v, step)),
      spacing_(fan.span / angles),
      step_(step),
      first_moment_(with_first_moment),
      entries_(std::size_t(angles_) * (steps_ + 1)) {
  const double reach = steps_ * step;
  const scene::HeightProfile one = scene::SameAtAllHeights{}, distance = scene::Layers{{0, reach}, {0, reach}};
  std::mutex mutex;
  scene::parallel_rows(angles_, execution, [&](int i) {
    const double angle = fan_.first + (i - 1) * spacing_;
    const MapLine line{u, v, 0, std::cos(angle), std::sin(angle), 1};
    const Interval inside = clip(map, line, {0, reach});
    Entry* entry = entries_.data() + std::size_t(i) * (steps_ + 1);
    Entry sum{0, 0, map.at(u, v)};
    entry[0] = sum;
    long cells = 0;
    for (int k = 0; k < steps_; ++k) {
      const Interval part = intersect(inside, {k * step, (k + 1) * step});
      if (!part.empty()) {
        sum.f += scene::integral(map, one, line, part, &cells);
        if (first_moment_) sum.s_f += scene::integral(map, distance, line, part);
      }
      sum.value = map.at(u + (k + 1) * step * line.du, v + (k + 1) * step * line.dv);
      entry[k + 1] = sum;
    }
    const std::lock_guard lock(mutex);
    cells_ += cells;
  });
}

PolarTable::Moments PolarTable::on_spoke(int angle, double r) const {
  const Entry* entry = entries_.data() + std::size_t(std::clamp(angle, 0, angles_ - 1)) * (steps_ + 1);
  const double place = r / step_;
  if (place >= steps_) return {entry[steps_].f, entry[steps_].s_f};
  const int k = int(place);
  const double t = place - k;
  const Entry &a = entry[k], &b = entry[k + 1];
  Moments m{hermite(t, a.f, step_ * a.value, b.f, step_ * b.value), 0};
  if (first_moment_) m.s_f = hermite(t, a.s_f, step_ * step_ * k * a.value, b.s_f, step_ * step_ * (k + 1) * b.value);
  return m;
}

PolarTable::Moments PolarTable::at(double du, double dv, double r) const {
  double angle = std::fmod(std::atan2(dv, du) - fan_.first, 2 * pi);
  if (angle < 0) angle += 2 * pi;
  const double place = angle / spacing_ + 1;
  const int i = std::min(int(place), angles_ - 2);
  double f[4], s_f[4];
  for (int k = 0; k < 4; ++k) {
    const Moments m = on_spoke(i + k - 1, r);
    f[k] = m.f;
    s_f[k] = m.s_f;
  }
  const double t = place - i;
  return {catmull_rom(t, f), first_moment_ ? catmull_rom(t, s_f) : 0};
}

}  // namespace airlight::wavelet_fog
