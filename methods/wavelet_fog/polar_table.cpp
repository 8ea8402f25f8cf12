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

PolarTable::PolarTable(const SplineMap& map, double u, double v, const Fan& fan, int angles, double step,
                       bool with_first_moment, const scene::Execution& execution)
    : fan_(fan),
      angles_(angles + 3),
      steps_(int(std::ceil(farthest(map, u, v) / step)) + 1),
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
