#include "methods/wavelet_fog/sun_map.h"

#include <algorithm>
#include <cmath>

#include "methods/wavelet_fog/interpolation.h"
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"

namespace airlight::wavelet_fog {
namespace {

using scene::ExponentialFall;
using scene::Fogmap;
using scene::HeightProfile;
using scene::MapLine;

MapLine to_sun_from(const Fogmap& fog, const Point3& x, const Vec3& to_sun) { return line_over(fog, {x, to_sun}); }

// Extent of the support along and across the azimuth.
struct Extent {
  double lo[2] = {infinity, infinity}, hi[2] = {-infinity, -infinity};
};
Extent turned_support(const Fogmap& fog, const double (&along)[2]) {
  Extent e;
  for (int corner = 0; corner < 4; ++corner) {
    const double u = corner & 1 ? fog.map.support_hi(0) : fog.map.support_lo(0);
    const double v = corner & 2 ? fog.map.support_hi(1) : fog.map.support_lo(1);
    const double place[2] = {u * along[0] + v * along[1], v * along[0] - u * along[1]};
    for (int a = 0; a < 2; ++a) {
      e.lo[a] = std::min(e.lo[a], place[a]);
      e.hi[a] = std::max(e.hi[a], place[a]);
    }
  }
  return e;
}

}  // namespace

double SunMap::entries(const Fogmap& fog, const Vec3& to_sun, double step) {
  const MapLine line = to_sun_from(fog, Point3::Zero(), to_sun);
  const double across = std::hypot(line.du, line.dv);
  if (fog.map.empty() || !(across > 0)) return 0;
  const Extent e = turned_support(fog, {line.du / across, line.dv / across});
  return ((e.hi[0] - e.lo[0]) / step + 2) * ((e.hi[1] - e.lo[1]) / step + 4);
}

SunRows rows_towards(const Fogmap& fog, const Vec3& to_sun, double step) {
  SunRows rows;
  const MapLine line = to_sun_from(fog, Point3::Zero(), to_sun);
  rows.across = std::hypot(line.du, line.dv);
  rows.upright = fog.map.empty() || !(rows.across > 0);
  if (rows.upright) return rows;
  rows.along[0] = line.du / rows.across;
  rows.along[1] = line.dv / rows.across;
  if (const auto* fall = std::get_if<ExponentialFall>(&fog.profile))
    rows.k = line.dy / (rows.across * fall->scale_height);
  const Extent e = turned_support(fog, rows.along);
  // A row beyond the support on either side, and one more to interpolate from.
  rows.columns = int(std::ceil((e.hi[0] - e.lo[0]) / step)) + 1;
  rows.rows = int(std::ceil((e.hi[1] - e.lo[1]) / step)) + 3;
  rows.lo[0] = e.lo[0];
  rows.lo[1] = e.lo[1] - step;
  return rows;
}

SunMap::SunMap(const scene::Medium& medium, const Vec3& to_sun, double step, const scene::Execution& execution,
               const SunMap* before)
    : medium_(&medium),
      fog_(std::get<scene::FogmapPointer>(medium.field).get()),
      to_sun_(to_sun),
      step_(step),
      rows_(rows_towards(*fog_, to_sun, step)) {
  if (rows_.upright) return;
  if (before && has_entries_of(*before)) {
    entries_ = before->entries_;
    return;
  }
  std::vector<Entry> entries(std::size_t(rows_.columns) * rows_.rows);
  scene::parallel_for(rows_.rows, execution, [&](int row) { fill_row(row, entries); });
  entries_ = std::make_shared<const std::vector<Entry>>(std::move(entries));
}

// Compares the inputs of fill_row(): rows in the map's own axes, the map, and whether it falls in layers.
bool SunMap::has_entries_of(const SunMap& before) const {
  const scene::SplineMap &a = fog_->map, &b = before.fog_->map;
  const auto layered = [](const Fogmap& fog) { return std::holds_alternative<scene::Layers>(fog.profile); };
  return before.entries_ && before.step_ == step_ && before.rows_ == rows_ && layered(*fog_) == layered(*before.fog_) &&
         (fog_ == before.fog_ ||
          (a.degree() == b.degree() && std::equal(a.range().size, a.range().size + 2, b.range().size) &&
           std::equal(a.range().lo, a.range().lo + 2, b.range().lo) && a.coefficients() == b.coefficients()));
}

// From the sun's side on.
void SunMap::fill_row(int row, std::vector<Entry>& entries) const {
  const double q = rows_.lo[1] + row * step_;
  const MapLine line{rows_.lo[0] * rows_.along[0] - q * rows_.along[1],
                     rows_.lo[0] * rows_.along[1] + q * rows_.along[0],
                     0,
                     rows_.along[0],
                     rows_.along[1],
                     1};
  const double reach = (rows_.columns - 1) * step_;
  const HeightProfile one = scene::SameAtAllHeights{};
  const bool layered = std::holds_alternative<scene::Layers>(fog_->profile);
  const Interval inside = clip(fog_->map, line, {0, reach});
  Entry* entry = entries.data() + std::size_t(row) * rows_.columns;
  Moments sum;
  for (int c = rows_.columns - 1; c >= 0; --c) {
    const Interval part = intersect(inside, {c * step_, (c + 1) * step_});
    sum.fallen *= std::exp(-rows_.k * step_);
    if (layered) sum.f1 += step_ * sum.f0;
    if (!part.empty()) {
      sum.f0 += scene::integral(fog_->map, one, line, part);
      if (layered)
        sum.f1 += scene::integral(fog_->map, scene::Layers{{c * step_, (c + 1) * step_}, {0, step_}}, line, part);
      if (rows_.k > 0)
        sum.fallen += scene::integral(fog_->map, ExponentialFall{c * step_, 1 / rows_.k}, line, part);
      else
        sum.fallen = sum.f0;
    }
    entry[c] = {sum, fog_->map.at(line.u + c * step_ * line.du, line.v + c * step_ * line.dv)};
  }
}

// p: from the first entry [cells].
SunMap::Moments SunMap::on_row(int row, double p) const {
  const Entry* entry = entries_->data() + std::size_t(std::clamp(row, 0, rows_.rows - 1)) * rows_.columns;
  const double place = p / step_;
  if (!(place > 0)) return entry[0].sum;
  if (!(place < rows_.columns - 1)) return {};
  const int c = int(place);
  const double t = place - c;
  const Entry &a = entry[c], &b = entry[c + 1];
  const auto between = [&](double from, double slope_from, double to, double slope_to) {
    return hermite(t, from, step_ * slope_from, to, step_ * slope_to);
  };
  return {between(a.sum.f0, -a.value, b.sum.f0, -b.value), between(a.sum.f1, -a.sum.f0, b.sum.f1, -b.sum.f0),
          between(a.sum.fallen, rows_.k * a.sum.fallen - a.value, b.sum.fallen, rows_.k * b.sum.fallen - b.value)};
}

SunMap::Moments SunMap::at(double p, double q) const {
  const double place = (q - rows_.lo[1]) / step_;
  if (!(place > -1 && place < rows_.rows)) return {};
  const int row = int(std::floor(place));
  double f0[4], f1[4], fallen[4];
  for (int i = 0; i < 4; ++i) {
    const Moments m = on_row(row + i - 1, p);
    f0[i] = m.f0, f1[i] = m.f1, fallen[i] = m.fallen;
  }
  const double t = place - row;
  return {catmull_rom(t, f0), catmull_rom(t, f1), catmull_rom(t, fallen)};
}

double SunMap::column(const Point3& x) const {
  const Ray ray{x, to_sun_};
  const Interval way = scene::extent(*medium_, ray, {0, infinity});
  if (way.empty()) return 0;
  if (rows_.upright || !(rows_.across * way.length() > least_way)) return density_integral(*medium_, ray, way);
  const MapLine line = line_over(*fog_, ray);
  const double p = line.u * rows_.along[0] + line.v * rows_.along[1] - rows_.lo[0],
               q = line.v * rows_.along[0] - line.u * rows_.along[1];
  const auto upto = [&](double t) { return std::isinf(t) ? Moments() : at(p + t * rows_.across, q); };
  double sum = 0;
  Moments from = upto(way.lo);
  const auto add = [&](Interval part) {
    const Moments to = upto(part.hi);
    // Inside, since at a knot there are two slopes; the last part may have no end.
    const double length = std::isinf(part.hi) ? 1 : part.length();
    const double a = part.lo + 0.25 * length, b = part.lo + 0.75 * length;
    const double ya = line.y + a * line.dy, yb = line.y + b * line.dy;
    const double fa = factor_at(fog_->profile, ya), fb = factor_at(fog_->profile, yb);
    const auto* fall = std::get_if<ExponentialFall>(&fog_->profile);
    if (fall && line.dy > 0 && ya > fall->base) {
      const double low = factor_at(fog_->profile, line.y + part.lo * line.dy);
      const double high = std::isinf(part.hi) ? 0 : factor_at(fog_->profile, line.y + part.hi * line.dy);
      sum += low * from.fallen - high * to.fallen;
    } else {
      const double beta = (fb - fa) / (b - a), alpha = fa - beta * (a - part.lo);  // from part.lo on, per metre
      sum += alpha * (from.f0 - to.f0);
      if (beta != 0) sum += beta * ((from.f1 - to.f1) / rows_.across - part.length() * to.f0);
    }
    from = to;
  };
  double start = way.lo;
  const auto cut_at = [&](double height) {
    const double t = (height - line.y) / line.dy;
    if (t > start && t < way.hi) add({start, t}), start = t;
  };
  const std::vector<double> heights = height_breaks(fog_->profile);
  if (line.dy > 0) std::for_each(heights.begin(), heights.end(), cut_at);
  if (line.dy < 0) std::for_each(heights.rbegin(), heights.rend(), cut_at);
  add({start, way.hi});
  return std::max(0.0, sum) / rows_.across;
}

}  // namespace airlight::wavelet_fog
