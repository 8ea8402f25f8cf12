#include "reference/deterministic/airlight.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "reference/deterministic/density_along_ray.h"
#include "reference/deterministic/gaussian_table.h"
#include "reference/deterministic/light_plane.h"
#include "reference/deterministic/shadow.h"
#include "scene/math/quadrature.h"

namespace airlight::deterministic {
namespace {

using scene::EquiangularMap;
using scene::Medium;
using scene::Panel;
using scene::Scene;

using Paths = std::vector<std::unique_ptr<DensityAlongRay>>;  // per medium; null where the ray misses it

bool scatters(const Medium& medium) { return (medium.albedo * medium.sigma_t).maxCoeff() > 0; }

// A stretch of the view ray, with u in [0, 1] as its coordinate. Places on the ray are x, the ray parameter less that
// of the point nearest to the light (directional lights: less 0): a ray that passes a light at 1e-12 needs x in more
// digits than t has.
struct Chart {
  const LightPlane* plane;
  int light;
  double lo, hi;       // x
  EquiangularMap map;  // point and spot lights

  Chart(const LightPlane& p, int l, double a, double b)
      : plane(&p), light(l), lo(a), hi(b), map(p.directional ? EquiangularMap(0, 1, 1) : EquiangularMap(a, b, p.h)) {}

  // The weight is dx/du for a directional light, (dx/du) / distance^2 for others.
  struct Place {
    double x, weight;
  };
  Place at(double u) const {
    if (!plane->directional) return {map.x(u), map.density()};
    if (!std::isinf(hi)) return {lo + u * (hi - lo), hi - lo};
    const double scale = 1 + std::abs(lo);
    return {lo + scale * u / (1 - u), scale / ((1 - u) * (1 - u))};
  }
};

// Sorted places to cut [range.lo, range.hi]: every sharp feature, and of the smooth ones no more than about one per
// width.
std::vector<double> cut(const std::vector<Feature>& features, Interval range) {
  std::vector<double> cuts{range.lo};
  for (const Feature& f : features) {
    if (!(f.t > range.lo && f.t < range.hi)) continue;
    if (f.t - cuts.back() > std::max(2 * f.width, 4e-16 * std::abs(f.t))) cuts.push_back(f.t);
  }
  cuts.push_back(range.hi);
  return cuts;
}

// The view ray through the media.
struct ViewPaths {
  Paths paths;
  std::vector<Feature> features;
  Interval range;  // hull of the scattering media
  bool fine = false;
};

// The view ray in pieces to integrate over, for all lights.
struct Pieces {
  std::vector<LightPlane> planes;  // never moved: charts point to them
  std::vector<Chart> charts;
  std::vector<Panel> panels;
};

}  // namespace

struct AirlightIntegrator::Impl {
  const Scene& scene;
  Accuracy accuracy;
  double depth_error;  // absolute, that many culled Gaussians may add up to
  std::vector<std::optional<GaussianTable>> tables;
  std::unique_ptr<ShadowFinder> shadows;

  Impl(const Scene& s, const Accuracy& a)
      : scene(s), accuracy(a), depth_error(1e-3 * std::max(a.relative_tolerance, 1e-13)), tables(s.media.size()) {
    for (std::size_t m = 0; m < scene.media.size(); ++m)
      if (const auto* sum = std::get_if<scene::GaussianSum>(&scene.media[m].field))
        tables[m] = make_gaussian_table(*sum);
    if (scene.geometry) shadows = std::make_unique<ShadowFinder>(*scene.geometry, 256);
  }

  double cull(std::size_t m) const {
    return tables[m] ? depth_error / double(std::max<std::size_t>(1, tables[m]->size())) : depth_error;
  }

  Rgb depth(const Ray& ray, Interval t) const {
    Rgb sum = Rgb::Zero();
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
      const double length = scene::density_integral(scene.media[m], ray, t);
      for (int c = 0; c < 3; ++c)
        if (scene.media[m].sigma_t[c] > 0) sum[c] += scene.media[m].sigma_t[c] * length;  // never 0 * infinity
    }
    return sum;
  }

  ViewPaths view_paths(const Ray& ray, double t_end) const;
  // False where the ray passes a light through scattering density.
  bool add_pieces(const Ray& ray, const ViewPaths& view, Pieces& pieces) const;
};

namespace {

// The integrand of one ray, over charts of all lights.
struct Integrand {
  const Scene& scene;
  const Paths& paths;
  const std::vector<Chart>& charts;
  const std::function<Rgb(const Ray&, double)>& light_path;
  const Ray& ray;
  // Optical depth (camera to point to light) seen since the last reset: how steep the exponential is.
  double least = infinity, greatest = -infinity, clearest = infinity;

  void reset() { least = infinity, greatest = -infinity, clearest = infinity; }

  Rgb operator()(int c, double u) {
    const Chart& chart = charts[c];
    const Chart::Place place = chart.at(u);
    const LightPlane& plane = *chart.plane;
    const double t = plane.foot + place.x;
    double cosine;
    Vec3 to_light;
    double distance = infinity;
    if (plane.directional) {
      to_light = plane.to_light;
      cosine = to_light.dot(ray.direction);
    } else {
      distance = std::hypot(place.x, plane.h);
      to_light = (plane.h * plane.normal_to_ray - place.x * ray.direction) / distance;
      cosine = -place.x / distance;
    }
    Rgb depth = Rgb::Zero();
    Rgb source = Rgb::Zero();
    for (std::size_t m = 0; m < paths.size(); ++m) {
      if (!paths[m]) continue;
      const Medium& medium = scene.media[m];
      depth += medium.sigma_t * paths[m]->integral(t);
      if (t < paths[m]->extent().lo || t > paths[m]->extent().hi || !scatters(medium)) continue;
      const double density = paths[m]->density(t);
      if (density > 0)
        source += medium.albedo * medium.sigma_t *
                  (density * scene::phase_value(medium.phase, std::clamp(cosine, -1.0, 1.0)));
    }
    if (!(source.maxCoeff() > 0)) return Rgb::Zero();
    const scene::Light& light = scene.lights[chart.light];
    if (plane.directional)
      source *= std::get<scene::DirectionalLight>(light).irradiance;
    else
      source *= scene::intensity_towards(light, -to_light);
    if (!(source.maxCoeff() > 0)) return Rgb::Zero();
    depth += plane.directional ? light_path({ray.at(t), to_light}, infinity)
                               : light_path({plane.light, -to_light}, distance);
    least = std::min(least, depth.maxCoeff());
    greatest = std::max(greatest, depth.maxCoeff());
    clearest = std::min(clearest, depth.minCoeff());
    // Not Eigen's exp, which stops at 1e-308: darkness must be 0, not a very small light that everything else is
    // compared with.
    return source * depth.unaryExpr([](double d) { return std::exp(-d); }) * place.weight;
  }
};

// Panels of one light, appended to charts and panels. Features are sorted, and like the charts in x.
void add_panels(const Scene& scene, const Paths& paths, const LightPlane& plane, int light,
                const std::vector<Feature>& features, const std::vector<Interval>& lit, std::vector<Chart>& charts,
                std::vector<Panel>& panels) {
  for (const Interval& stretch : lit) {
    const std::vector<double> cuts = cut(features, {stretch.lo - plane.foot, stretch.hi - plane.foot});
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const double lo = cuts[i], hi = cuts[i + 1];
      if (!(hi > lo)) continue;
      const double middle = plane.foot + (std::isinf(hi) ? 2 * std::abs(lo) + 1 : 0.5 * (lo + hi));
      bool inside = false;
      for (std::size_t m = 0; m < paths.size(); ++m)
        inside |=
            paths[m] && scatters(scene.media[m]) && middle >= paths[m]->extent().lo && middle <= paths[m]->extent().hi;
      if (!inside) continue;
      charts.emplace_back(plane, light, lo, hi);
      panels.push_back({0, 1, int(charts.size()) - 1});
    }
  }
}

// Where a ray passes through a light of radius 0: is there scattering density?
bool meets_light(const Scene& scene, const Paths& paths, const LightPlane& plane) {
  if (plane.directional || plane.h > 0) return false;
  for (std::size_t m = 0; m < paths.size(); ++m) {
    if (!paths[m] || !scatters(scene.media[m])) continue;
    const Interval extent = paths[m]->extent();
    if (plane.foot >= extent.lo && plane.foot <= extent.hi && paths[m]->density(plane.foot) > 0) return true;
  }
  return false;
}

// Everything that cuts the ray for one light, sorted, in x.
std::vector<Feature> features_for(const LightPlane& plane, const scene::Light& light, std::vector<Feature> features,
                                  const std::vector<double>& kinks, Interval range) {
  for (const double t : kinks) features.push_back({t, 0});
  if (const auto* spot = std::get_if<scene::SpotLight>(&light)) {
    std::vector<double> cone;
    add_cone(plane, *spot, cone);
    for (const double t : cone) features.push_back({t, 0});
  }
  for (Feature& f : features) f.t -= plane.foot;
  if (!plane.directional) {
    features.push_back({0, 0});
    // The inverse square has the scale h; exp(-distance) and the media have theirs. Steps in between by powers.
    const double reach = std::isinf(range.hi) ? 1e3 + 2 * std::abs(plane.foot) : range.hi + std::abs(plane.foot);
    if (plane.h > 0)
      for (double step = 4 * plane.h; step < reach; step *= 32)
        features.insert(features.end(), {{-step, 0}, {step, 0}});
  }
  std::sort(features.begin(), features.end(), [](const Feature& a, const Feature& b) { return a.t < b.t; });
  return features;
}

// First estimates. A panel over which the depth changes by many e-folds might show the rule only zeros: it is halved
// until it does not, if what it can hold at all, by its ends and nodes, matters.
class FirstEstimates {
 public:
  // steepest: e-folds that the rule resolves.
  FirstEstimates(Integrand& integrand, const scene::QuadratureOptions& options, double steepest)
      : integrand_(integrand), options_(options), steepest_(steepest), per_panel_(2 * options.rule->half - 1) {}

  void add(Panel p) {
    integrand_.reset();
    scene::estimate_panel(integrand_, *options_.rule, p);
    evaluations += per_panel_;
    total_ += p.value;
    clearest_ = std::min(clearest_, integrand_.clearest);
    if (integrand_.greatest - integrand_.least > steepest_ && p.hi - p.lo > 1e-15)
      steep_.push_back({p, integrand_.clearest});
    else
      panels.push_back(p);
  }

  void halve_steep() {
    while (!steep_.empty()) {
      const auto [p, least_depth] = steep_.back();
      steep_.pop_back();
      const bool wanted = matters(p, least_depth);
      if (wanted && evaluations + 2 * per_panel_ <= options_.max_evaluations) {
        const double middle = p.lo + 0.5 * (p.hi - p.lo);
        total_ -= p.value;
        add({p.lo, middle, p.chart});
        add({middle, p.hi, p.chart});
      } else {
        spent = spent || wanted;
        panels.push_back(p);
      }
    }
  }

  std::vector<Panel> panels;  // none of them steep, or not worth halving
  long evaluations = 0;
  bool spent = false;  // evaluations ran out before panels that matter were halved

 private:
  // Upper bound of a panel's contribution, by its ends and nodes. While all nodes are in the dark, panels with a
  // bright end are refined, and the least dark ones: a panel of another light may be the least dark of all.
  bool matters(const Panel& p, double least_depth) {
    const double width = p.hi - p.lo;
    Rgb most = p.value;
    const auto look = [&](double inset) {
      const Rgb ends = integrand_(p.chart, p.lo + inset * width).max(integrand_(p.chart, p.hi - inset * width));
      evaluations += 2;
      most = most.max(width * ends);
      return (total_ > 0).any() ? (most > 1e-4 * options_.relative_tolerance * total_).any()
                                : (most > 0).any() || least_depth < clearest_ + 300;
    };
    return look(1e-9) || look(1e-15);  // extinctions from 1e10 on: 1e-9 of a panel is dark too
  }

  Integrand& integrand_;
  const scene::QuadratureOptions& options_;
  const double steepest_;
  const long per_panel_;
  std::vector<std::pair<Panel, double>> steep_;  // with the least depth seen in it
  Rgb total_ = Rgb::Zero();
  double clearest_ = infinity;
};

}  // namespace

AirlightIntegrator::AirlightIntegrator(const Scene& scene, const Accuracy& accuracy)
    : impl_(std::make_unique<Impl>(scene, accuracy)) {}
AirlightIntegrator::~AirlightIntegrator() = default;

Rgb AirlightIntegrator::optical_depth(const Ray& ray, double t) const { return impl_->depth(ray, {0, t}); }

Rgb AirlightIntegrator::light_depth(const Point3& x, int light) const {
  const scene::Incident in = scene::incident(impl_->scene.lights[light], x);
  return impl_->depth({x, in.to_light}, {0, in.distance});
}

ViewPaths AirlightIntegrator::Impl::view_paths(const Ray& ray, double t_end) const {
  ViewPaths view;
  view.paths.resize(scene.media.size());
  for (std::size_t m = 0; m < scene.media.size(); ++m) {
    auto& path = view.paths[m];
    path = density_along_ray(scene.media[m], tables[m] ? &*tables[m] : nullptr, ray, t_end, cull(m));
    if (!path) continue;
    path->add_features(view.features);
    view.fine |= path->fine();
    if (!scatters(scene.media[m])) continue;
    view.range = {std::min(view.range.lo, path->extent().lo), std::max(view.range.hi, path->extent().hi)};
  }
  return view;
}

bool AirlightIntegrator::Impl::add_pieces(const Ray& ray, const ViewPaths& view, Pieces& pieces) const {
  pieces.planes.reserve(scene.lights.size());
  for (std::size_t l = 0; l < scene.lights.size(); ++l) {
    const scene::Light& light = scene.lights[l];
    if (!scene::is_delta(light)) continue;
    const LightPlane& plane = pieces.planes.emplace_back(light_plane(ray, light));
    std::vector<Feature> features = view.features;
    std::vector<double> kinks;
    for (std::size_t m = 0; m < scene.media.size(); ++m) {
      const Medium& medium = scene.media[m];
      if (!(medium.sigma_t.maxCoeff() > 0)) continue;
      add_medium(plane, medium, kinks);
      if (tables[m]) add_gaussian_shadows(plane, *tables[m], medium.sigma_t.maxCoeff(), cull(m), features);
    }
    if (meets_light(scene, view.paths, plane)) return false;
    const std::vector<Interval> lit = shadows ? shadows->lit(plane, view.range) : std::vector<Interval>{view.range};
    add_panels(scene, view.paths, plane, int(l), features_for(plane, light, std::move(features), kinks, view.range),
               lit, pieces.charts, pieces.panels);
  }
  return true;
}

Airlight AirlightIntegrator::operator()(const Ray& ray, double t_end) const {
  Airlight result;
  const ViewPaths view = impl_->view_paths(ray, t_end);
  if (view.range.empty()) return result;
  Pieces pieces;
  if (!impl_->add_pieces(ray, view, pieces)) {
    // int dx/x^2 through the light: there is no finite answer.
    result.radiance = result.error = Rgb::Constant(infinity);
    result.converged = false;
    return result;
  }
  const std::function<Rgb(const Ray&, double)> light_path = [&](const Ray& path, double distance) {
    return impl_->depth(path, {0, distance});
  };
  Integrand integrand{impl_->scene, view.paths, pieces.charts, light_path, ray};
  scene::QuadratureOptions options;
  options.relative_tolerance = impl_->accuracy.relative_tolerance;
  options.max_evaluations = impl_->accuracy.max_evaluations;
  options.rule = view.fine ? &scene::kronrod7() : &scene::kronrod15();
  FirstEstimates first(integrand, options, view.fine ? 6 : 12);
  for (const Panel& p : pieces.panels) first.add(p);
  first.halve_steep();
  const scene::Integral integral = scene::refine_panels(integrand, first.panels, options, first.evaluations);
  result.radiance = integral.value;
  result.error = integral.error;
  result.evaluations = integral.evaluations;
  result.converged = integral.converged && !first.spent;
  return result;
}

Airlight airlight(const Scene& scene, const Ray& ray, double t_end, const Accuracy& accuracy) {
  return AirlightIntegrator(scene, accuracy)(ray, t_end);
}

}  // namespace airlight::deterministic
