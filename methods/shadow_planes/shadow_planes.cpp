#include "methods/shadow_planes/shadow_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/shadow_planes/lit_airlight.h"
#include "methods/shadow_planes/tile_edges.h"
#include "scene/error.h"
#include "scene/stopwatch.h"

namespace airlight::shadow_planes {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

struct Needs {
  bool medium, shadows, surfaces;
};

// What rows count.
struct Counts {
  double parts = 0, crossings = 0;
};

class PreparedShadowPlanes final : public scene::Prepared {
 public:
  PreparedShadowPlanes(std::shared_ptr<const Scene> scene, const Options& options)
      : scene_(std::move(scene)), options_(options) {
    const bool lit = !scene_->lights.empty();
    const bool medium = std::any_of(scene_->media.begin(), scene_->media.end(), [](const scene::Medium& m) {
      return (m.sigma_t * std::get<scene::Homogeneous>(m.field).density > 0).any();
    });
    needs_ = {medium, medium && lit && !scene_->surfaces.empty() && options.shadows != Options::Shadows::none,
              lit && !scene_->surfaces.empty()};
    scene::Stopwatch watch;
    if (medium) airlight_ = std::make_unique<LitAirlight>(scene_->media, options);
    if (!needs_.shadows) return;
    const auto occluders = std::make_shared<const Occluders>(scene_);
    times_.push_back({"edges", watch.lap()});
    for (const scene::Light& light : scene_->lights) shadows_.emplace_back(occluders, scene::ball(light)->center);
    times_.push_back({"silhouettes", watch.lap()});
  }

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;

 private:
  // `at_camera`: m there, by light; empty where every ray starts elsewhere.
  void render_tile(const View&, int tile_x, int tile_y, const std::vector<int>& at_camera, scene::Film&, Counts&) const;
  Rgb airlight(std::size_t light, const Ray&, double end, int count, const std::vector<int>& edges,
               std::vector<Crossing>&, std::vector<ShadowVolumes::Interval>&, Counts&) const;
  Rgb by_stencil(std::size_t light, const Ray&, double end, int count, const std::vector<int>& edges,
                 std::vector<Crossing>&, Counts&) const;
  Rgb reflected(const scene::Hit&, const Vec3& to_view) const;

  std::shared_ptr<const Scene> scene_;
  Options options_;
  Needs needs_;
  std::unique_ptr<LitAirlight> airlight_;  // null: no medium
  std::vector<ShadowVolumes> shadows_;     // by light; empty: left out
  std::vector<scene::StageTime> times_;
};

std::vector<scene::Stage> PreparedShadowPlanes::stages() const {
  const std::size_t edges =
      std::accumulate(shadows_.begin(), shadows_.end(), std::size_t(0),
                      [](std::size_t sum, const ShadowVolumes& s) { return sum + s.edges().size(); });
  const bool lit = !scene_->lights.empty();
  const std::string dark = !lit ? "no light shines" : "", clear = !needs_.medium ? "there is no medium" : dark;
  const auto unless = [](const std::string& reason, const std::string& otherwise) {
    return reason.empty() ? otherwise : reason;
  };
  return {
      {"silhouettes", needs_.shadows,
       unless(clear, scene_->surfaces.empty() ? "there are no surfaces"
                     : needs_.shadows         ? fmt::format("{} edges for {} light{}", edges, scene_->lights.size(),
                                                    scene_->lights.size() == 1 ? "" : "s")
                                              : "shadows = none")},
      {"airlight", needs_.medium && lit,
       unless(clear, options_.evaluator == Options::Evaluator::rule
                         ? fmt::format("{} nodes on each lit part", options_.nodes)
                     : options_.annex ? std::string("the polynomials of the annex")
                                      : fmt::format("polynomials of degree {}", options_.degree))},
      {"surfaces", needs_.surfaces,
       scene_->surfaces.empty() ? "there are none" : unless(dark, "direct light through the media")},
      {"ambient in-scatter", options_.ambient,
       options_.ambient ? "asked for" : "ambient = false: not a part of single scattering"},
  };
}

Rgb PreparedShadowPlanes::airlight(std::size_t index, const Ray& ray, double end, int count,
                                   const std::vector<int>& edges, std::vector<Crossing>& crossings,
                                   std::vector<ShadowVolumes::Interval>& lit, Counts& counts) const {
  const scene::Light& light = scene_->lights[index];
  if (!needs_.shadows) {
    counts.parts += 1;
    return (*airlight_)(light, ray, {0, end});
  }
  shadows_[index].lit_parts(ray, end, count, &edges, crossings, lit);
  counts.crossings += double(crossings.size());
  Rgb sum = Rgb::Zero();
  if (options_.shadows == Options::Shadows::counted) {
    for (const auto& part : lit) sum += (*airlight_)(light, ray, {part.begin, part.end});
    counts.parts += double(lit.size());
    return sum;
  }
  if (options_.shadows == Options::Shadows::stencil)
    return by_stencil(index, ray, end, count, edges, crossings, counts);
  // As if every plane alone were a shadow's: the integral of 1 - m/2.
  double m = count, from = 0;
  const auto add = [&](double to) {
    if (to > from && m != 2) sum += (1 - 0.5 * m) * (*airlight_)(light, ray, {from, to});
    from = to;
    counts.parts += 1;
  };
  for (const Crossing& crossing : crossings) {
    add(crossing.x);
    m += crossing.change;
  }
  add(end);
  return sum;
}

// Section 5.1.5 with the stencil's rules put right: from the point that ends the ray to the eye, in the order of the
// middles of edges. Each plane adds or takes away all light in front of it.
Rgb PreparedShadowPlanes::by_stencil(std::size_t index, const Ray& ray, double end, int count,
                                     const std::vector<int>& edges, std::vector<Crossing>& crossings,
                                     Counts& counts) const {
  crossings.clear();
  shadows_[index].cross_edges(ray, end, edges, crossings, options_.edge_split);
  shadows_[index].cross_spheres(ray, end, crossings);
  int stencil = count;
  for (const Crossing& crossing : crossings) stencil += crossing.change;
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.order < b.order; });
  Rgb sum = Rgb::Zero();
  const auto draw = [&](double x, double sign) {
    counts.parts += 1;
    sum += sign * (*airlight_)(scene_->lights[index], ray, {0, x});
    if (options_.frame_buffer) sum = ((sum * 255).round() / 255).max(0.0).min(1.0);
  };
  if (stencil == 0) draw(end, 1);
  for (const Crossing& crossing : crossings) {
    if (crossing.change > 0 && stencil == crossing.change) draw(crossing.x, 1);
    if (crossing.change < 0 && stencil == 0) draw(crossing.x, -1);
    stencil = std::max(0, stencil - crossing.change);
  }
  return sum;
}

Rgb PreparedShadowPlanes::reflected(const scene::Hit& hit, const Vec3& to_view) const {
  Rgb sum = Rgb::Zero();
  for (const scene::Light& light : scene_->lights) {
    const scene::Incident in = scene::incident(light, hit.position);
    const double cosine = hit.normal.dot(in.to_light);
    if (!(cosine > 0) || !(in.irradiance > 0).any()) continue;
    const Point3 start = scene_->geometry->offset_origin(hit.position, hit.normal, in.to_light);
    if (scene_->geometry->occluded({start, in.to_light}, in.distance)) continue;
    sum += scene::brdf(scene_->surfaces[hit.surface].material, hit.normal, in.to_light, to_view) * cosine *
           in.irradiance * transmittance(scene_->media, {hit.position, in.to_light}, {0, in.distance});
  }
  return sum;
}

void PreparedShadowPlanes::render_tile(const View& view, int tile_x, int tile_y, const std::vector<int>& at_camera,
                                       scene::Film& film, Counts& counts) const {
  std::vector<std::vector<int>> edges(scene_->lights.size());
  for (std::size_t l = 0; l < shadows_.size(); ++l) edges_of_tile(shadows_[l], view, tile_x, tile_y, edges[l]);
  std::vector<Crossing> crossings;
  std::vector<ShadowVolumes::Interval> lit;
  std::vector<float>&airlight_layer = film.layers["airlight"], &surface = film.layers["surface"],
  &transmittance_layer = film.layers["transmittance"], &mean = film.layers["mean"];
  for (int y = tile_y * tile_side; y < std::min(view.height, (tile_y + 1) * tile_side); ++y)
    for (int x = tile_x * tile_side; x < std::min(view.width, (tile_x + 1) * tile_side); ++x) {
      const Ray ray = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
      const scene::RayEnd end = scene::ray_end(*scene_, ray);
      Rgb in_air = Rgb::Zero(), on_surface = Rgb::Zero(), visible = Rgb::Ones();
      if (needs_.medium) {
        visible = transmittance(scene_->media, ray, {0, end.t});
        for (std::size_t l = 0; l < scene_->lights.size(); ++l) {
          const int count = !needs_.shadows ? 0 : !at_camera.empty() ? at_camera[l] : shadows_[l].count(ray.origin);
          in_air += airlight(l, ray, end.t, count, edges[l], crossings, lit, counts);
        }
        if (options_.ambient) in_air += scene_->ambient_in_scatter * (1 - visible);
      }
      if (end.hit) on_surface = visible * reflected(*end.hit, -ray.direction);
      const std::size_t i = std::size_t(y) * view.width + x;
      for (int c = 0; c < 3; ++c) {
        airlight_layer[3 * i + c] = float(in_air[c]);
        surface[3 * i + c] = float(on_surface[c]);
        transmittance_layer[3 * i + c] = float(visible[c]);
        mean[3 * i + c] = float(in_air[c] + on_surface[c]);
      }
    }
}

scene::Rendering PreparedShadowPlanes::render(const View& view, const Execution& execution) const {
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  for (const char* layer : {"airlight", "surface", "transmittance", "mean"}) result.film.add(layer);
  scene::Stopwatch watch;
  const int columns = (view.width + tile_side - 1) / tile_side, rows = (view.height + tile_side - 1) / tile_side;
  std::vector<int> at_camera;
  if (view.camera.kind == scene::Camera::Kind::perspective)
    for (const ShadowVolumes& shadows : shadows_) at_camera.push_back(shadows.count(view.camera.position));
  std::vector<Counts> counts(std::size_t(columns) * rows);
  scene::parallel_rows(columns * rows, execution, [&](int tile) {
    render_tile(view, tile % columns, tile / columns, at_camera, result.film, counts[tile]);
  });
  result.times.push_back({"airlight and surfaces", watch.lap()});
  Counts all;
  for (const Counts& c : counts) all = {all.parts + c.parts, all.crossings + c.crossings};
  result.counters["rays"] = double(result.film.pixels());
  result.counters["lit_parts"] = all.parts;
  result.counters["crossings"] = all.crossings;
  return result;
}

}  // namespace

std::string ShadowPlanes::about() const {
  return "single scattering of point and spot lights in homogeneous media with exact shadows (Biri et al. 2006)";
}

std::vector<scene::SettingSpec> ShadowPlanes::settings() const { return setting_specs(); }

std::vector<std::string> ShadowPlanes::supports(const Scene& scene, const scene::Settings& settings) const {
  const Options options = read_options(settings);
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    if (!std::holds_alternative<scene::Homogeneous>(scene.media[i].field))
      reasons.push_back(
          fmt::format("medium {} is {}, expected homogeneous media", i, field_name(scene.media[i].field)));
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (!scene::ball(scene.lights[i]))
      reasons.push_back(
          fmt::format("light {} is a {} light, expected point and spot lights", i, light_name(scene.lights[i])));
  if (options.evaluator == Options::Evaluator::polynomial) {
    if (scene.media.size() > 1 ||
        (scene.media.size() == 1 && !std::holds_alternative<scene::Unbounded>(scene.media.front().region)))
      reasons.push_back("evaluator = polynomial is for one medium without a region");
    for (const scene::Light& light : scene.lights)
      if (std::holds_alternative<scene::SpotLight>(light))
        reasons.push_back("evaluator = polynomial is for point lights: a spot's edge has no Taylor series");
    if (options.annex && scene.media.size() == 1 &&
        std::holds_alternative<scene::HenyeyGreenstein>(scene.media.front().phase))
      reasons.push_back("annex = true: the annex has no coefficients for Henyey-Greenstein");
    if (options.annex && options.centred)
      reasons.push_back("annex = true: its coefficients are about theta = 0, expected centred = false");
  }
  return reasons;
}

std::unique_ptr<scene::Prepared> ShadowPlanes::prepare(std::shared_ptr<const Scene> scene,
                                                       const scene::Settings& settings, const Execution&) const {
  const std::vector<std::string> reasons = supports(*scene, settings);
  if (!reasons.empty())
    throw Error(fmt::format("{}: shadow_planes cannot render this: {}", scene->name, reasons.front()));
  return std::make_unique<PreparedShadowPlanes>(std::move(scene), read_options(settings));
}

}  // namespace airlight::shadow_planes
