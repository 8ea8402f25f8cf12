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

double level_up_to(const Options& o, const scene::Fogmap& fog, int level) {
  return std::ldexp(o.near * fog.cell, level);
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
  if (options_.table > 0) table_.emplace(bands_.back().pieces(), options_.table, options_.lookup);
}

// Of the paper's sum, with tables or wavelets: band 0 is complete, m counts up to its distance.
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
  const double reach = length_in_box(levels_, line, length);
  const auto part = [&](int level, double from, double to) {
    return integral_of_level(levels_.grid[level], level, profile, line, intersect(inside, {from, to}), visits);
  };
  if (!bands_.empty()) return summed_bands(profile, line, inside, reach, visits);
  switch (o.variant) {
    case Variant::pre:
    case Variant::direct:
      return part(0, 0, length);
    case Variant::polar:  // rays that are not from the eye
    case Variant::skip:
      return skipped_depth(levels_, *blocks_, profile, line, way, enough_, visits);
    case Variant::paper:
      return summed_depth(levels_, profile, line, inside, reach, o.mu, visits);
    case Variant::tele:
      return telescoped_depth(levels_, profile, line, inside, reach, o.mu, visits);
    case Variant::dist: {
      double sum = 0, from = 0;
      for (int level = 0; level <= levels_.count() && from < length && sum <= enough_; ++level) {
        const double to = level == levels_.count() ? length : std::min(length, level_up_to(o, *fog_, level));
        sum += part(level, from, to);
        from = to;
      }
      return sum;
    }
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
  const PolarTable::Fan fan = fan_of(*fog_, view);
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
  const Interval t = scene::extent(*medium_, ray, {0, length});
  if (t.empty()) return 0;
  const scene::MapLine line = line_over(*fog_, ray);
  const double across = std::hypot(line.du, line.dv);  // cells over the ground per metre
  if (!(across * t.length() > upright)) return column(ray, length, visits);
  const auto upto = [&](double at) {
    ++visits.cells;
    return table.at(line.du, line.dv, at * across);
  };
  if (std::holds_alternative<scene::SameAtAllHeights>(fog_->profile))
    return (upto(t.hi).f - (t.lo > 0 ? upto(t.lo).f : 0)) / across;
  // Between knots the factor is alpha + beta s.
  std::vector<double> cuts{t.lo};
  if (line.dy != 0)
    for (const double height : height_breaks(fog_->profile))
      if (const double cut = (height - line.y) / line.dy; cut > t.lo && cut < t.hi) cuts.push_back(cut);
  cuts.push_back(t.hi);
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  PolarTable::Moments from = t.lo > 0 ? upto(t.lo) : PolarTable::Moments();
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const PolarTable::Moments to = upto(cuts[i + 1]);
    const double a = cuts[i] + 0.25 * (cuts[i + 1] - cuts[i]), b = cuts[i + 1] - 0.25 * (cuts[i + 1] - cuts[i]);
    const double fa = factor_at(fog_->profile, line.y + a * line.dy),
                 fb = factor_at(fog_->profile, line.y + b * line.dy);
    const double beta = b > a ? (fb - fa) / ((b - a) * across) : 0, alpha = fa - beta * a * across;
    sum += alpha * (to.f - from.f) + beta * (to.s_f - from.s_f);
    from = to;
  }
  return sum / across;
}

}  // namespace airlight::wavelet_fog
