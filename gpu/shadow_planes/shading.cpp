#include "gpu/shadow_planes/shading.h"

#include <algorithm>

#include "gpu/material_tables.h"
#include "gpu/program.h"
#include "gpu/shadow_planes/rule_on_device.h"
#include "gpu/view_uniforms.h"
#include "methods/shadow_planes/phase_form.h"
#include "methods/shadow_planes/polynomial.h"

namespace airlight::gpu {
namespace {

using shadow_planes::Options;

// The layout of media.glsl.
struct MediumData {
  double lo[3], hi[3];
  float extinction[3], albedo[3];
  int region, phase;
  float g, scale, width;
  int unused;
};

Rgb extinction_of(const scene::Medium& medium) {
  return medium.sigma_t * std::get<scene::Homogeneous>(medium.field).density;
}

// What a region is made of, as media.glsl.
struct RegionNumbers {
  int kind;
  Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();
};
RegionNumbers numbers(const scene::Region& region) {
  if (const auto* box = std::get_if<Box>(&region)) return {1, box->lo, box->hi};
  if (const auto* sphere = std::get_if<scene::Sphere>(&region)) return {2, sphere->center, Vec3(sphere->radius, 0, 0)};
  if (const auto* slab = std::get_if<scene::Slab>(&region)) return {3, slab->normal, Vec3(slab->lo, slab->hi, 0)};
  return {0};
}

std::vector<MediumData> media_data(const scene::Scene& scene, bool printed) {
  std::vector<MediumData> data;
  for (const scene::Medium& medium : scene.media) {
    const shadow_planes::PhaseForm phase = shadow_planes::phase_form(medium.phase, printed);
    const RegionNumbers region = numbers(medium.region);
    MediumData d{{}, {}, {}, {}, region.kind, int(phase.kind), float(phase.g), float(phase.scale), float(phase.width()),
                 0};
    for (int i = 0; i < 3; ++i) {
      d.lo[i] = region.lo[i];
      d.hi[i] = region.hi[i];
      d.extinction[i] = float(extinction_of(medium)[i]);
      d.albedo[i] = float(medium.albedo[i]);
    }
    data.push_back(d);
  }
  return data;
}

// Regions seen from each light, six numbers each: the shader's nodes are in single precision.
std::vector<float> from_lights(const scene::Scene& scene) {
  std::vector<float> values;
  for (const scene::Light& light : scene.lights)
    for (const scene::Medium& medium : scene.media) {
      RegionNumbers region = numbers(medium.region);
      const Point3 at = scene::ball(light)->center;
      if (region.kind == 1 || region.kind == 2) region.lo -= at;
      if (region.kind == 1) region.hi -= at;
      if (region.kind == 3) region.hi -= Vec3(region.lo.dot(at), region.lo.dot(at), 0);
      for (const Vec3& v : {region.lo, region.hi})
        for (int i = 0; i < 3; ++i) values.push_back(float(v[i]));
    }
  return values;
}

std::vector<float> evaluator_numbers(const scene::Scene& scene, const Options& options, bool bounded) {
  if (options.evaluator == Options::Evaluator::rule) return rule_nodes(options.nodes, options.stretch, bounded);
  std::vector<float> values;
  if (scene.media.empty()) return values;
  const auto phase = shadow_planes::phase_form(scene.media.front().phase, options.printed_phases);
  for (const auto& row :
       options.annex ? shadow_planes::printed_in_a(phase) : shadow_planes::coefficients_in_a(phase, options.degree))
    for (const double c : row) values.push_back(float(c));
  return values;
}

bool is_bounded(const scene::Scene& scene) {
  return scene.media.size() > 1 ||
         (scene.media.size() == 1 && !std::holds_alternative<scene::Unbounded>(scene.media.front().region));
}

}  // namespace

PlaneShading::Picture::Picture(Context& context, const scene::View& v)
    : view(v),
      airlight(context, "airlight of lights", std::size_t(v.width) * v.height * 16),
      reflected(context, "light on surfaces", std::size_t(v.width) * v.height * 16),
      counters(context, "counters", 12) {}

PlaneShading::PlaneShading(Context& context, const scene::Scene& scene, const Options& options,
                           const SurfacesOnDevice* surfaces)
    : context_(context),
      scene_(scene),
      options_(options),
      surfaces_(surfaces),
      medium_(std::any_of(scene.media.begin(), scene.media.end(),
                          [](const scene::Medium& m) { return (extinction_of(m) > 0).any(); })),
      bounded_(is_bounded(scene)),
      grey_(std::all_of(scene.media.begin(), scene.media.end(),
                        [](const scene::Medium& m) { return (extinction_of(m) == extinction_of(m)[0]).all(); })),
      media_(context, "media", media_data(scene, options.printed_phases)),
      from_lights_(context, "regions from lights", from_lights(scene)),
      evaluator_(context, "evaluator", evaluator_numbers(scene, options, bounded_)),
      materials_(context, "materials", MaterialTables(scene).materials),
      tables_(context, "reflectance tables", MaterialTables(scene).values) {
  if (options.evaluator == Options::Evaluator::polynomial && !scene.media.empty())
    degree_ = options.annex ? int(shadow_planes::printed_in_a(
                                      shadow_planes::phase_form(scene.media.front().phase, options.printed_phases))
                                      .size()) -
                                  1
                            : options.degree;
}

void PlaneShading::add(Picture& picture, int index, const std::vector<int>& counts, const TileBins* bins,
                       const LightEdges* edges) const {
  const Use use(context_);
  const scene::Light& light = scene_.lights[index];
  const auto* spot = std::get_if<scene::SpotLight>(&light);
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const bool polynomial = options_.evaluator == Options::Evaluator::polynomial;
  Program& p = context_.program("shadow_planes/shade.comp", {{"LOCAL_SIZE_X", "16"},
                                                             {"LOCAL_SIZE_Y", "8"},
                                                             {"AIRLIGHT", flag(medium_)},
                                                             {"BOUNDED", flag(bounded_)},
                                                             {"CROSSINGS", flag(bins)},
                                                             {"GREY", flag(grey_)},
                                                             {"POLYNOMIAL", flag(polynomial)},
                                                             {"POWER", std::to_string(options_.stretch)},
                                                             {"SHADOWS", std::to_string(int(options_.shadows))},
                                                             {"SPOT", flag(spot)},
                                                             {"SURFACES", flag(!scene_.surfaces.empty())}});
  const Buffer count_buffer(context_, "counts where rays begin", counts);
  if (bins) {
    edges->edges->bind(0);
    bins->bind();
  }
  if (picture.primitives) picture.primitives->bind(1);
  if (surfaces_) surfaces_->bind();
  materials_.bind(2);
  evaluator_.bind(5);
  picture.airlight.bind(6);
  picture.reflected.bind(7);
  media_.bind(8);
  tables_.bind(9);
  count_buffer.bind(13);
  picture.counters.bind(14);
  if (bounded_) from_lights_.bind(15);
  set_view(p, picture.view);
  p.set_double("light", scene::ball(light)->center);
  p.set("intensity", spot ? spot->intensity : std::get<scene::PointLight>(light).intensity);
  if (spot) {
    p.set_double("spot_axis", spot->axis);
    p.set_double("cos_inner", std::cos(spot->inner_angle));
    p.set_double("cos_outer", std::cos(spot->outer_angle));
  }
  p.set("triangle_count", surfaces_ ? surfaces_->triangles() : 0);
  p.set("solid_count", surfaces_ ? int(surfaces_->solids().size()) : 0);
  p.set("has_primitives", picture.primitives != nullptr);
  p.set("counts_per_pixel", counts.size() > 1);
  p.set("tile_columns", TileBins::columns(picture.view));
  p.set("media_count", int(scene_.media.size()));
  p.set("edge_split", options_.edge_split);
  p.set("frame_buffer", options_.frame_buffer);
  if (bounded_) p.set("first_region", int(index * scene_.media.size()));
  if (polynomial)
    p.set("degree", degree_);
  else
    p.set("rule_nodes", options_.nodes);
  p.dispatch(picture.view.width, picture.view.height);
}

void PlaneShading::compose(const Picture& picture, const Layers& layers) const {
  const Use use(context_);
  Program& p = context_.program("shadow_planes/composition.comp", {{"LOCAL_SIZE_X", "16"}, {"LOCAL_SIZE_Y", "8"}});
  if (picture.primitives) picture.primitives->bind(1);
  if (surfaces_) surfaces_->bind();
  picture.airlight.bind(6);
  picture.reflected.bind(7);
  media_.bind(8);
  layers.airlight.bind(0);
  layers.transmittance.bind(3);
  layers.surface.bind(4);
  layers.mean.bind(5);
  set_view(p, picture.view);
  p.set("triangle_count", surfaces_ ? surfaces_->triangles() : 0);
  p.set("has_primitives", picture.primitives != nullptr);
  p.set("media_count", int(scene_.media.size()));
  p.set("ambient", options_.ambient ? scene_.ambient_in_scatter : Rgb::Zero());
  p.dispatch(picture.view.width, picture.view.height);
}

}  // namespace airlight::gpu
