#include "gpu/shadow_planes/shading.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/material_tables.h"
#include "gpu/program.h"
#include "gpu/view_uniforms.h"
#include "methods/shadow_planes/paper_stages.h"
#include "scene/error.h"

namespace airlight::gpu {

using shadow_planes::Options;

LitPicture::LitPicture(Context& context, const scene::View& v, bool shadows)
    : view(v),
      pixels(context, fmt::format("light of {} x {} pixels", v.width, v.height), std::size_t(v.width) * v.height * 32),
      states(context, fmt::format("states of {} x {} pixels", v.width, v.height),
             shadows ? std::size_t(v.width) * v.height * 48 : 48),
      counters(context, "counters", 20) {}

PlaneShading::PlaneShading(Context& context, const std::shared_ptr<const scene::Scene>& scene, const Options& options,
                           const AirlightTermsOnDevice& airlight_terms, const SurfacesOnDevice* surfaces)
    : context_(context),
      scene_(scene),
      options_(options),
      airlight_terms_(airlight_terms),
      surfaces_(surfaces),
      materials_(context, "materials", MaterialTables(*scene).materials),
      tables_(context, "reflectance tables", MaterialTables(*scene).values) {}

// Edges whose planes cannot cut a medium's box, by their places; `edges` null: there are none.
std::unique_ptr<Buffer> PlaneShading::left_out(const LightEdges* edges, const Box& box, const Point3& light) const {
  const int count = edges ? edges->count : 0;
  auto flags = std::make_unique<Buffer>(context_, "planes left out", 4 * std::size_t(count));
  if (count == 0) return flags;
  edges->edges->bind(0);
  flags->bind(15);
  Program& p = context_.program("shadow_planes/left_out.comp", {{"LOCAL_SIZE_X", "64"}});
  p.set("edge_count", count);
  p.set_double("box_lo", Vec3(box.lo - light));
  p.set_double("box_hi", Vec3(box.hi - light));
  p.dispatch(count);
  return flags;
}

void PlaneShading::add(LitPicture& picture, int index, int term, const std::vector<int>& counts, const Edges& lists,
                       const VertexValues* values) const {
  const Use use(context_);
  const scene::Light& light = scene_->lights[index];
  const auto* spot = std::get_if<scene::SpotLight>(&light);
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const scene::Region* region = term >= 0 ? airlight_terms_.region(term) : nullptr;
  // Values at vertices are drawn by the paper's stages, with or without shadows.
  const bool stages = term >= 0 && (values || (options_.shadows == Options::Shadows::stencil && lists.edges));
  auto definitions = airlight_terms_.definitions(index, term);
  definitions.insert({{"LOCAL_SIZE_X", "16"},
                      {"LOCAL_SIZE_Y", "8"},
                      {"AIRLIGHT", flag(term >= 0)},
                      {"COUNT_BY_PIXEL", flag(counts.size() > 1)},
                      {"CROSSINGS", flag(lists.edges)},
                      {"SHADOWS", std::to_string(int(options_.shadows))},
                      {"STENCIL", flag(stages)},
                      {"SURFACES", flag(!scene_->surfaces.empty())},
                      {"VERTICES", flag(values)}});
  Program& p = context_.program("shadow_planes/shade.comp", definitions);
  std::unique_ptr<Buffer> by_pixel, flags;
  if (counts.size() > 1) {
    by_pixel = std::make_unique<Buffer>(context_, "counts where rays begin", counts);
    by_pixel->bind(13);
  }
  if (stages && region) {
    flags = left_out(lists.edges, bounding_box(*region), scene::ball(light)->center);
    flags->bind(15);
    p.set("boundary_cells", options_.boundary_cells);
  }
  airlight_terms_.bind(p, index, term);
  if (values) {
    values->bind(p);
    p.set("media_end", shadow_planes::all_end(scene_->media));
  }
  if (lists.edges) {
    lists.edges->edges->bind(0);
    p.set("edge_count", lists.edges->count);
  }
  if (lists.fan) lists.fan->bind(p);
  if (picture.primitives) picture.primitives->bind(1);
  if (surfaces_) surfaces_->bind();
  materials_.bind(2);
  picture.pixels.bind(6);
  picture.states.bind(7);
  tables_.bind(9);
  picture.counters.bind(14);
  set_view(p, picture.view);
  p.set("intensity", spot ? spot->intensity : std::get<scene::PointLight>(light).intensity);
  p.set("triangle_count", surfaces_ ? surfaces_->triangles() : 0);
  p.set("solid_count", surfaces_ ? int(surfaces_->solids().size()) : 0);
  p.set("has_primitives", picture.primitives != nullptr);
  p.set("count_at_camera", counts.front());
  p.set("reflects", term <= 0);
  p.set("edge_split", options_.edge_split);
  p.set("frame_buffer", options_.frame_buffer && stages);
  p.set("loop_count", 3);
  for (bool resume = false;; resume = true) {
    p.set("resume", resume);
    p.dispatch(picture.view.width, picture.view.height);
    std::vector<unsigned> counters = picture.counters.download<unsigned>();
    if (counters[4] != 0)
      throw Unavailable(
          fmt::format("gpu: {} ends the loops of a pixel after 65535 iterations, too few for {} nodes and {} crossings",
                      context_.renderer(), options_.nodes, counters[1]));
    if (counters[3] == 0) return;
    counters[3] = 0;
    picture.counters.upload(counters);
  }
}

void PlaneShading::compose(const LitPicture& picture, const Layers& layers) const {
  const Use use(context_);
  Program& p = context_.program("shadow_planes/composition.comp", {{"LOCAL_SIZE_X", "16"}, {"LOCAL_SIZE_Y", "8"}});
  if (picture.primitives) picture.primitives->bind(1);
  if (surfaces_) surfaces_->bind();
  picture.pixels.bind(6);
  airlight_terms_.bind_media(p);
  layers.airlight.bind(0);
  layers.transmittance.bind(3);
  layers.surface.bind(4);
  layers.mean.bind(5);
  set_view(p, picture.view);
  p.set("triangle_count", surfaces_ ? surfaces_->triangles() : 0);
  p.set("has_primitives", picture.primitives != nullptr);
  p.set("ambient", options_.ambient ? scene_->ambient_in_scatter : Rgb::Zero());
  p.dispatch(picture.view.width, picture.view.height);
}

}  // namespace airlight::gpu
