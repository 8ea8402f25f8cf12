#include "methods/legendre_fluids/light_rays.h"

#include <algorithm>
#include <cmath>

#include "scene/math/legendre_series.h"
#include "scene/media/legendre_line.h"

namespace airlight::legendre_fluids {
namespace {

constexpr double edge_share = 1. / 4096;  // of the way between two shadow rays: how well an edge is known
constexpr int most_kink_halvings = 12;    // of a stretch where light has kinks
constexpr Eigen::Index last_orders = 3;   // of a column's coefficients: what these are is what is missed beyond
constexpr double least_share = 4e-16;     // of where it is: a piece that rounding made
constexpr double rounding_share = 0.01;   // of the tolerance, that polynomials of columns may cost
constexpr double bent_share = 0.1;        // of the tolerance, that that may be

}  // namespace

// One ray under one light.
struct LightRays::Walk {
  const LightRays& rays;
  const Ray& ray;
  std::size_t light;
  std::vector<Rgb> source;     // of each medium, per density: albedo sigma_t p, in the unit of `unit`
  std::vector<double> before;  // of each medium: the density so far [m]
  const Eigen::VectorXd& node;
  const Eigen::MatrixXd& analysis;
  PanelSeries series;
  Rgb sum = Rgb::Zero();
  RayVisits& visits;

  Walk(const LightRays& of, const Ray& over, std::size_t l, RayVisits& v)
      : rays(of),
        ray(over),
        light(l),
        before(of.media_.media.size(), 0.0),
        node(scene::legendre_points(of.media_.coefficients).node),
        analysis(scene::legendre_points(of.media_.coefficients).analysis),
        visits(v) {
    const LitMedia& lit = of.media_;
    for (const LitMedium& m : lit.media) {
      // Light goes on along -to_light before, and along -direction after.
      const double c = std::clamp(lit.lights[l].to_light.dot(ray.direction), -1.0, 1.0);
      source.push_back(m.medium->albedo * m.medium->sigma_t * phase_value(m.medium->phase, c));
    }
    series.depths = lit.grey ? 1 : 3;
    series.sources = lit.media.size() == 1 ? 1 : 3;
  }

  // Unit of the sum: with one medium its density alone, and colours are multiplied at the end.
  Rgb unit() const {
    const Rgb irradiance = rays.media_.lights[light].irradiance;
    return source.size() == 1 ? Rgb(irradiance * source[0]) : irradiance;
  }

  // Channel c of the series: depths come first.
  Eigen::Map<Eigen::VectorXd> channel(int c) { return {series.coefficients.data() + c * node.size(), node.size()}; }

  // Values of a density at the Gauss points of a stretch within its box.
  Eigen::VectorXd densities(const scene::LegendreBox& field, const Eigen::VectorXd& t) const {
    Eigen::VectorXd values(t.size());
    const Vec3 origin = field.local(ray.at(t[0])), slope = 2 * ray.direction.cwiseQuotient(field.box().size());
    for (Eigen::Index begin = 0; begin < t.size(); begin += lanes) {
      const Eigen::Index here = std::min<Eigen::Index>(lanes, t.size() - begin);
      Lanes at = Lanes::Zero();
      at.head(here) = t.segment(begin, here).array() - t[0];
      const Lanes all = series_values(field.shape(), field.coefficients().data(), origin[0] + slope[0] * at,
                                      origin[1] + slope[1] * at, origin[2] + slope[2] * at);
      values.segment(begin, here) = all.head(here).max(0);
    }
    return values;
  }

  void stretch(Interval t, bool visible, int halvings = 0);
};

void LightRays::Walk::stretch(Interval t, bool visible, int halvings) {
  const std::vector<LitMedium>& media = rays.media_.media;
  const Point3 middle = ray.at(0.5 * (t.lo + t.hi));
  const auto inside = [&](const LitMedium& m) { return m.field->box().contains(middle); };
  if (std::none_of(media.begin(), media.end(), inside)) return;
  const Eigen::Index n = node.size();
  const Eigen::VectorXd places = t.lo + 0.5 * t.length() * (1 + node.array());
  std::vector<Eigen::VectorXd> columns(media.size());
  for (std::size_t m = 0; m < media.size() && visible; ++m) {
    Eigen::VectorXd values(n);
    media[m].columns[light]->along(ray, places.data(), int(n), values.data());
    columns[m] = analysis * values;
    const double missed =
        columns[m].tail(std::min(last_orders, n)).cwiseAbs().sum() * media[m].medium->sigma_t.maxCoeff();
    if (media[m].field->negative() && halvings < most_kink_halvings && missed > bent_share * rays.options_.tolerance) {
      const double half = 0.5 * (t.lo + t.hi);
      stretch({t.lo, half}, visible, halvings + 1);
      return stretch({half, t.hi}, visible, halvings + 1);
    }
  }
  series.coefficients.assign(std::size_t((series.depths + series.sources) * n), 0);
  for (std::size_t m = 0; m < media.size(); ++m) {
    Eigen::VectorXd depth = Eigen::VectorXd::Zero(n);
    depth[0] = std::sqrt(2.0) * before[m];
    if (visible) depth += columns[m];
    if (inside(media[m])) {
      const Eigen::VectorXd density = analysis * densities(*media[m].field, places);
      depth += 0.5 * t.length() * scene::series_primitive(density).head(n);
      before[m] += 0.5 * t.length() * std::sqrt(2.0) * std::max(0.0, density[0]);
      for (int c = 0; c < series.sources; ++c)
        channel(series.depths + c) += (series.sources == 1 ? 1 : source[m][c]) * density;
    }
    for (int c = 0; c < series.depths; ++c) channel(c) += media[m].medium->sigma_t[c] * depth;
  }
  if (!visible) return;
  ++visits.segments;
  rays.rule_.add(series, 0.5 * t.length(), sum, visits.work);
}

LightRays::LightRays(const scene::Scene& scene, const RayOptions& options, const LightRays* before)
    : geometry_(scene.geometry.get()),
      options_(options),
      media_(scene, before ? &before->media_ : nullptr),
      columns_made_(media_.find_columns(rounding_share * options.tolerance, before ? &before->media_ : nullptr)),
      rule_(before && before->rule_.coefficients() == media_.coefficients
                ? before->rule_
                : PanelRule(media_.coefficients, options.points, options.tolerance)),
      shadowed_(shadowed_lights(scene, media_)) {}

bool LightRays::shadowed() const { return std::find(shadowed_.begin(), shadowed_.end(), true) != shadowed_.end(); }

// Ascending; between two of them everything is a polynomial, or nothing is.
std::vector<double> LightRays::cuts(const Ray& ray, double end, std::size_t light) const {
  std::vector<double> cuts, planes;
  Interval range;
  for (const LitMedium& m : media_.media) {
    const Interval inside = scene::extent(*m.field, ray, {0, end});
    if (inside.empty()) continue;
    range = {std::min(range.lo, inside.lo), std::max(range.hi, inside.hi)};
    cuts.insert(cuts.end(), {inside.lo, inside.hi});
    planes.clear();
    m.columns[light]->cuts(ray, true, planes);
    for (const double t : planes)
      if (t > inside.lo && t < inside.hi) cuts.push_back(t);
    if (!m.field->negative()) continue;
    const scene::LegendreLine line(*m.field, ray, inside);
    for (const Interval& positive : line.positive()) cuts.insert(cuts.end(), {positive.lo, positive.hi});
  }
  planes.clear();
  for (const LitMedium& m : media_.media)  // one medium's shadow in another
    if (media_.media.size() > 1) m.columns[light]->cuts(ray, false, planes);
  for (const double t : planes)
    if (t > range.lo && t < range.hi) cuts.push_back(t);
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

// Where the light is seen from the ray, as lit and dark by turns from the range's begin on; found by shadow rays, and bisection between two
// that differ.
LightRays::Visibility LightRays::visibility(const Ray& ray, Interval range, std::size_t light,
                                            RayVisits& visits) const {
  const auto seen = [&](double t) {
    ++visits.shadow_rays;
    return !geometry_->occluded({ray.at(t), media_.lights[light].to_light});
  };
  Visibility found;
  const double step = range.length() / options_.shadow_steps;
  bool before = found.first = seen(range.lo + 0.5 * step);
  for (int i = 1; i < options_.shadow_steps; ++i) {
    double lo = range.lo + (i - 0.5) * step, hi = lo + step;
    if (seen(hi) == before) continue;
    while (hi - lo > edge_share * step) {
      const double middle = 0.5 * (lo + hi);
      (seen(middle) == before ? lo : hi) = middle;
    }
    found.changes.push_back(0.5 * (lo + hi));
    before = !before;
  }
  return found;
}

Rgb LightRays::airlight(const Ray& ray, double end, RayVisits& visits) const {
  Rgb total = Rgb::Zero();
  for (std::size_t light = 0; light < media_.lights.size(); ++light) {
    std::vector<double> cuts = this->cuts(ray, end, light);
    if (cuts.size() < 2) continue;
    Visibility visible;
    if (shadowed_[light]) visible = visibility(ray, {cuts.front(), cuts.back()}, light, visits);
    cuts.insert(cuts.end(), visible.changes.begin(), visible.changes.end());
    std::sort(cuts.begin(), cuts.end());
    Walk walk(*this, ray, light, visits);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const Interval piece{cuts[i], cuts[i + 1]};
      if (piece.length() <= least_share * std::max(std::abs(piece.hi), cuts.back() - cuts.front())) continue;
      const auto turns = std::upper_bound(visible.changes.begin(), visible.changes.end(), piece.lo);
      walk.stretch(piece, visible.first == ((turns - visible.changes.begin()) % 2 == 0));
    }
    total += walk.unit() * walk.sum;
  }
  return total;
}

}  // namespace airlight::legendre_fluids
