#include "methods/wavelet_fog/sun_scattering.h"

#include <algorithm>
#include <cmath>

#include "scene/light/scattered_lights.h"
#include "scene/math/gauss_legendre.h"
#include "scene/media/fogmap.h"

namespace airlight::wavelet_fog {
namespace {

using scene::ExponentialFall;
using scene::Medium;

constexpr double opaque = 40;             // optical depth beyond which nothing comes through
constexpr double most_change = 0.5;       // of an optical depth over a piece
constexpr int most_halvings = 12;         // of a cell
constexpr int most_deep_halvings = 48;    // where extinction asks for it: what is lit may be as thin as that
constexpr double edge_share = 1. / 4096;  // of the way between two shadow rays: how well an edge is known

const scene::Fogmap& fog_of(const Medium& medium) { return *std::get<scene::FogmapPointer>(medium.field); }

// Where the ray is in the medium. An upright ray may not leave it: it ends where it is opaque.
Interval finite_extent(const Medium& medium, const Ray& ray, double length) {
  Interval way = scene::extent(medium, ray, {0, length});
  if (way.empty() || !std::isinf(way.hi)) return way;
  double last = way.lo;
  for (const double height : height_breaks(fog_of(medium).profile))
    if (const double t = (height - ray.origin[1]) / ray.direction[1]; std::isfinite(t)) last = std::max(last, t);
  const double rho = density(medium, ray.at(last + 1));
  double thinnest = infinity;
  for (const double sigma : medium.sigma_t)
    if (sigma > 0) thinnest = std::min(thinnest, sigma);
  return {way.lo, rho > 0 ? last + opaque / (thinnest * rho) : last};
}

// Edges between light and shadow, from stretches that begin lit or not.
struct Visibility {
  bool lit_first = true;
  std::vector<double> changes;
};

// By shadow rays within the cells, `steps` at least over all of them, and bisection between two that differ.
Visibility visibility(const scene::Geometry& geometry, const Ray& ray, const Vec3& to_sun,
                      const std::vector<Interval>& cells, int per_cell, int steps, long& rays) {
  const auto lit = [&](double t) {
    ++rays;
    return !geometry.occluded({ray.at(t), to_sun});
  };
  double way = 0;
  for (const Interval& cell : cells) way += cell.length();
  Visibility found;
  double before = 0;
  bool was_lit = true, first = true;
  for (const Interval& cell : cells) {
    const int count = std::max(per_cell, int(std::ceil(steps * cell.length() / way)));
    for (int i = 0; i < count; ++i) {
      const double t = cell.lo + (i + 0.5) / count * cell.length();
      const bool is_lit = lit(t);
      if (first) found.lit_first = was_lit = is_lit;
      if (is_lit != was_lit) {
        double a = before, b = t;
        while (b - a > edge_share * (t - before)) {
          const double middle = 0.5 * (a + b);
          (lit(middle) == was_lit ? a : b) = middle;
        }
        found.changes.push_back(0.5 * (a + b));
      }
      before = t;
      was_lit = is_lit;
      first = false;
    }
  }
  return found;
}

}  // namespace

std::string why_no_sun(const scene::Scene& scene) {
  const auto is_sun = [](const scene::Light& light) { return std::holds_alternative<scene::DirectionalLight>(light); };
  const auto shines = [&](const scene::Light& light) { return is_sun(light) && scene::shines(light); };
  const auto scattered = [&](const scene::Light& light) { return is_sun(light) && scatter(scene.media, light); };
  if (std::any_of(scene.lights.begin(), scene.lights.end(), scattered)) return "";
  if (std::none_of(scene.media.begin(), scene.media.end(), scene::extinguishes)) return "no fog extinguishes";
  return std::none_of(scene.lights.begin(), scene.lights.end(), shines) ? "no directional light shines"
                                                                        : "the albedo is 0 where a sun shines";
}

struct SunScattering::Along {
  Along(const Sun& of, const Ray& over, std::size_t points)
      : sun(of), ray(over), extinction(points), scattering(points), to_sun(points) {}
  const Sun& sun;
  const Ray& ray;
  std::vector<Rgb> source;  // of each medium, per density: albedo sigma_t p E
  double climb = 0;         // scale heights per metre, of the steepest medium
  long points = 0;
  Rgb depth = Rgb::Zero(), sum = Rgb::Zero();
  std::vector<Rgb> extinction, scattering, to_sun;  // at the points of a piece
};

SunScattering::Rule SunScattering::rule_of(int points) {
  const scene::GaussLegendre gauss = scene::gauss_legendre(points);
  Rule rule;
  for (int k = 0; k < points; ++k) {
    rule.node.push_back(0.5 + 0.5 * gauss.node[k]);
    rule.weight.push_back(0.5 * gauss.weight[k]);
  }
  for (int k = 0; k < points; ++k)
    for (int term = 0; term < points; ++term) {
      double integral = 0;
      for (int i = 0; i < points; ++i) {
        const double x = rule.node[k] * rule.node[i];
        double lagrange = 1;
        for (int other = 0; other < points; ++other)
          if (other != term) lagrange *= (x - rule.node[other]) / (rule.node[term] - rule.node[other]);
        integral += rule.node[k] * rule.weight[i] * lagrange;
      }
      rule.upto.push_back(integral);
    }
  return rule;
}

SunScattering::SunScattering(const scene::Scene& scene, const Options& options, const scene::Execution& execution,
                             const SunScattering* before)
    : geometry_(scene.geometry.get()),
      shadow_steps_(options.shadow_steps),
      least_(std::max(options.termination, std::exp(-opaque))) {
  int points = options.sun_points;
  for (const Medium& medium : scene.media) {
    if (!extinguishes(medium)) continue;
    media_.push_back(&medium);
    points = std::max(points, fog_of(medium).map.degree() + 1);  // a cell's optical depth is exact
  }
  rule_ = rule_of(points);
  for (const scene::Light& light : scene.lights) {
    const auto* sun = std::get_if<scene::DirectionalLight>(&light);
    if (!sun || !scatter(scene.media, light)) continue;
    suns_.push_back({*sun, {}});
    // Most suns and fogs keep their number from frame to frame.
    const std::size_t s = suns_.size() - 1;
    for (std::size_t m = 0; m < media_.size(); ++m) {
      const bool known = before && s < before->suns_.size() && m < before->media_.size();
      const SunMap* map = known ? &before->suns_[s].maps[m] : nullptr;
      suns_[s].maps.emplace_back(*media_[m], sun->to_light, options.sun_step, execution, map);
      if (!map || !map->shares_entries(suns_[s].maps.back())) ++maps_made_;
    }
  }
}

// Stretches on which every density is a polynomial, or one times an exponential, and not all are zero.
std::vector<Interval> SunScattering::cells(const Ray& ray, double length) const {
  std::vector<double> cuts;
  for (const Medium* medium : media_) {
    const Interval way = finite_extent(*medium, ray, length);
    if (way.empty()) continue;
    const std::vector<double> own = smooth_between(fog_of(*medium), ray, way);
    cuts.push_back(way.lo);
    cuts.insert(cuts.end(), own.begin(), own.end());
    cuts.push_back(way.hi);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<Interval> cells;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const Interval cell{cuts[i], cuts[i + 1]};
    if (cell.empty()) continue;
    const auto something = [&](double node) {
      const Point3 x = ray.at(cell.lo + node * cell.length());
      return std::any_of(media_.begin(), media_.end(), [&](const Medium* m) { return density(*m, x) > 0; });
    };
    if (std::any_of(rule_.node.begin(), rule_.node.end(), something)) cells.push_back(cell);
  }
  return cells;
}

// A piece without edge of a shadow; halved where an optical depth changes much.
void SunScattering::add(Along& along, Interval t, bool lit, int halvings) const {
  if (t.empty() || !((-along.depth).exp().maxCoeff() > least_)) return;
  const std::size_t points = rule_.node.size();
  Rgb total = Rgb::Zero(), least = Rgb::Constant(infinity), most = Rgb::Zero();
  for (std::size_t k = 0; k < points; ++k) {
    const Point3 x = along.ray.at(t.lo + rule_.node[k] * t.length());
    Rgb &extinction = along.extinction[k], &scattering = along.scattering[k], &to_sun = along.to_sun[k];
    extinction = scattering = to_sun = Rgb::Zero();
    for (std::size_t i = 0; i < media_.size(); ++i) {
      const Medium& medium = *media_[i];
      if (const double rho = density(medium, x); rho > 0) {
        extinction += medium.sigma_t * rho;
        scattering += along.source[i] * rho;
      }
      const double column = lit ? along.sun.maps[i].column(x) : 0;
      for (int c = 0; c < 3; ++c)
        if (medium.sigma_t[c] > 0) to_sun[c] += medium.sigma_t[c] * column;
    }
    total += t.length() * rule_.weight[k] * extinction;
    least = least.min(to_sun);
    most = most.max(to_sun);
  }
  along.points += long(points);
  const bool deep = total.maxCoeff() > most_change;
  bool coarse = deep || along.climb * t.length() > 1;
  for (int c = 0; c < 3 && lit; ++c) coarse = coarse || (least[c] < opaque && most[c] - least[c] > most_change);
  if (coarse && halvings < (deep ? most_deep_halvings : most_halvings)) {
    const double middle = t.lo + 0.5 * t.length();
    add(along, {t.lo, middle}, lit, halvings + 1);
    add(along, {middle, t.hi}, lit, halvings + 1);
    return;
  }
  for (std::size_t k = 0; k < points && lit; ++k) {
    Rgb depth = along.depth + along.to_sun[k];
    for (std::size_t term = 0; term < points; ++term)
      depth += t.length() * rule_.upto[k * points + term] * along.extinction[term];
    along.sum += t.length() * rule_.weight[k] * along.scattering[k] * (-depth).exp();
  }
  along.depth += total;
}

Rgb SunScattering::scattered(const Sun& sun, const Ray& ray, const std::vector<Interval>& cells,
                             SunVisits& visits) const {
  const std::size_t points = rule_.node.size();
  Along along(sun, ray, points);
  for (const Medium* m : media_) {
    // Light goes on along -to_light before, and along -direction after.
    const double p = phase_value(m->phase, std::clamp(sun.light.to_light.dot(ray.direction), -1.0, 1.0));
    along.source.push_back(m->albedo * m->sigma_t * p * sun.light.irradiance);
    if (const auto* fall = std::get_if<ExponentialFall>(&fog_of(*m).profile))
      along.climb = std::max(along.climb, std::abs(ray.direction[1]) / fall->scale_height);
  }
  Visibility seen;
  if (geometry_)
    seen = visibility(*geometry_, ray, sun.light.to_light, cells, int(points), shadow_steps_, visits.shadow_rays);
  bool lit = seen.lit_first;
  std::size_t change = 0;
  for (const Interval& cell : cells) {
    double from = cell.lo;
    for (; change < seen.changes.size() && seen.changes[change] < cell.hi; ++change, lit = !lit) {
      add(along, {from, seen.changes[change]}, lit);
      from = std::max(from, seen.changes[change]);
    }
    add(along, {from, cell.hi}, lit);
  }
  visits.points += along.points;
  return along.sum;
}

Rgb SunScattering::airlight(const Ray& ray, double length, SunVisits& visits) const {
  Rgb sum = Rgb::Zero();
  const std::vector<Interval> parts = cells(ray, length);
  if (parts.empty()) return sum;
  for (const Sun& sun : suns_) sum += scattered(sun, ray, parts, visits);
  return sum;
}

}  // namespace airlight::wavelet_fog
