#include "methods/wavelet_fog/leveled_fog.h"

#include <algorithm>
#include <cmath>

namespace airlight::wavelet_fog {

using Variant = Options::Variant;

double enough_column(const scene::Medium& medium, const Options& options) {
  const double thinnest = medium.sigma_t.minCoeff();
  return options.termination > 0 && thinnest > 0 ? -std::log(options.termination) / thinnest : infinity;
}

namespace {

bool same_map(const scene::SplineMap& a, const scene::SplineMap& b) {
  const scene::IndexRange &x = a.range(), &y = b.range();
  return a.degree() == b.degree() && std::equal(x.lo, x.lo + 2, y.lo) && std::equal(x.size, x.size + 2, y.size) &&
         a.coefficients() == b.coefficients();
}

}  // namespace

LeveledFog::LeveledFog(const scene::Medium& medium, const Options& options)
    : medium_(&medium),
      fog_(std::get<scene::FogmapPointer>(medium.field).get()),
      options_(options),
      levels_(make_levels(fog_->map, family_of_degree(fog_->map.degree()), options.coarse,
                          uses_levels(options.variant) ? options.levels : 0, options.variant == Variant::paper)) {
  if (options.variant == Variant::skip || options.variant == Variant::polar)
    blocks_.emplace(levels_, empty_blocks, false);
  if (options.variant == Variant::bound) blocks_.emplace(levels_, options.levels, true);
  if (options.table > 0 || options.variant == Variant::pre) lay_bands();
  enough_ = enough_column(medium, options);
}

void LeveledFog::become(const scene::Medium& medium) {
  const scene::Fogmap& now = *std::get<scene::FogmapPointer>(medium.field);
  const bool same = &now == fog_ || same_map(now.map, fog_->map);
  medium_ = &medium;
  fog_ = &now;
  if (!same || (table_ && needs_moments() != table_->moments())) {
    *this = LeveledFog(medium, options_);
    return;
  }
  enough_ = enough_column(medium, options_);
}

// A table's lookups are for a factor of the height that is 1, or straight along a cell.
bool LeveledFog::needs_moments() const {
  return options_.fade > 0 || !std::holds_alternative<scene::SameAtAllHeights>(fog_->profile);
}

void LeveledFog::lay_bands() {
  const int L = levels_.count();
  bands_.emplace_back(levels_.grid[L], L);
  if (options_.variant == Variant::pre) {
    if (L > 0) {
      const Family& wavelets = family(family_of_degree(fog_->map.degree()));
      const Decomposition d = decompose({fog_->map.range(), fog_->map.coefficients()}, wavelets, L);
      for (int l = L; l >= 1; --l) bands_.emplace_back(d.levels[l - 1], wavelets, l);
    }
  } else if (options_.variant == Variant::paper) {
    for (int l = L - 1; l >= 0; --l) bands_.emplace_back(levels_.detail[l], l);
  }
  if (options_.table > 0) table_.emplace(bands_.back().pieces(), options_.table, options_.lookup, needs_moments());
}

// Algorithm 1's loop over levels, with tables or wavelets: band 0 is complete, m counts up to its distance. Its walk over the cells of a level
// is BandGrid::integral.
double LeveledFog::summed_bands(const scene::HeightProfile& profile, const scene::MapLine& line, Interval inside,
                                double length, Visits& visits) const {
  double sum = 0;
  for (std::size_t m = 0; m < bands_.size(); ++m)
    sum += bands_[m].integral(profile, line, intersect(inside, {0, reach_of(int(m), length, options_.mu)}),
                              table_ ? &*table_ : nullptr, visits);
  return sum;
}

double LeveledFog::column(const Ray& ray, double length, Visits& visits) const {
  const Options& o = options_;
  scene::MapLine line = line_over(*fog_, ray);
  scene::HeightProfile faded;
  if (o.fade > 0) {  // along the ray the vertical distance from the eye only grows
    faded = scene::ExponentialFall{0, o.fade};
    line.y = 0;
    line.dy = std::abs(line.dy);
  }
  const scene::HeightProfile& profile = o.fade > 0 ? faded : fog_->profile;
  // The finest grid ends where the medium does; coarser ones reach beyond, within the region.
  const Interval way = scene::extent(*medium_, ray, {0, length});
  const Interval inside = scene::clip(medium_->region, ray, {0, length});
  if (inside.empty() || (way.empty() && !uses_levels(o.variant))) return 0;
  const double eye_to_end = length_in_box(levels_, line, length);  // |OP|
  const auto part = [&](int level, double from, double to) {
    return integral_of_level(levels_.grid[level], level, profile, line, intersect(inside, {from, to}), visits);
  };
  if (!bands_.empty()) return summed_bands(profile, line, inside, eye_to_end, visits);
  switch (o.variant) {
    case Variant::pre:
    case Variant::direct:
      return part(0, 0, length);
    case Variant::polar:  // rays that are not from the eye
    case Variant::skip:
      return skipped_depth(levels_, *blocks_, profile, line, way, enough_, visits);
    case Variant::paper:
      return summed_depth(levels_, profile, line, inside, eye_to_end, o.mu, visits);
    case Variant::tele:
      return telescoped_depth(levels_, profile, line, inside, eye_to_end, o.mu, visits);
    case Variant::bound: {
      // The error is shared out over the way in the fog, in the thickest channel.
      const double thickest = medium_->sigma_t.maxCoeff();
      if (way.empty() || !(thickest > 0)) return 0;
      return bounded_depth(levels_, *blocks_, profile, line, way, o.tolerance / (thickest * way.length()), enough_,
                           visits);
    }
  }
  return 0;
}

PolarTable LeveledFog::polar_table(const scene::View& view, const scene::Execution& execution) const {
  const scene::MapLine line = line_over(*fog_, {view.camera.position, Vec3::UnitX()});
  const PolarTable::Fan fan = fan_of(*fog_, view, options_.angles);
  const int angles = fan.span == 2 * pi ? 2 * options_.angles : options_.angles;
  return {fog_->map,
          line.u,
          line.v,
          fan,
          angles,
          options_.radial_step,
          std::holds_alternative<scene::Layers>(fog_->profile),
          execution};
}

double LeveledFog::column(const PolarTable& table, const Ray& ray, double length, Visits& visits) const {
  Interval t = scene::clip(medium_->region, ray, {0, length});
  const scene::MapLine line = line_over(*fog_, ray);
  const double across = std::sqrt(line.du * line.du + line.dv * line.dv);  // cells over the ground per metre
  const double metres = 1 / across;                                        // per cell; infinite for an upright ray
  t.hi = std::min(t.hi, table.reach() * metres);  // the map need not be met: the table knows where it is
  const auto* layers = std::get_if<scene::Layers>(&fog_->profile);
  if (layers && line.dy != 0) {
    const Interval heights = occupied_heights(fog_->profile);
    const double a = (heights.lo - line.y) / line.dy, b = (heights.hi - line.y) / line.dy;
    t = intersect(t, {std::min(a, b), std::max(a, b)});
  }
  if (t.empty()) return 0;
  if (!(across * t.length() > upright)) return column(ray, length, visits);
  const PolarTable::Place place = table.place(line.du, line.dv);
  const auto upto = [&](double at) {
    ++visits.lookups;
    return table.at(place, at * across);
  };
  PolarTable::Moments before = t.lo > 0 ? upto(t.lo) : PolarTable::Moments();
  if (!layers) return (upto(t.hi).f - before.f) * metres;
  double sum = 0, from = t.lo;
  const auto add = [&](double to) {  // between knots the factor is alpha + beta s
    const PolarTable::Moments after = upto(to);
    const double a = from + 0.25 * (to - from), b = to - 0.25 * (to - from);
    const double fa = factor_at(fog_->profile, line.y + a * line.dy),
                 fb = factor_at(fog_->profile, line.y + b * line.dy);
    const double beta = b > a ? (fb - fa) / ((b - a) * across) : 0, alpha = fa - beta * a * across;
    sum += alpha * (after.f - before.f) + beta * (after.s_f - before.s_f);
    before = after;
    from = to;
  };
  const int knots = int(layers->heights.size());
  for (int k = 0; k < knots && line.dy != 0; ++k) {  // in the order that the ray meets them
    const double cut = (layers->heights[line.dy > 0 ? k : knots - 1 - k] - line.y) / line.dy;
    if (cut > from && cut < t.hi) add(cut);
  }
  add(t.hi);
  return sum * metres;
}

}  // namespace airlight::wavelet_fog
