#include "gpu/shadow_planes/shading.h"

#include <algorithm>

#include "gpu/film_layers.h"
#include "gpu/material_tables.h"
#include "gpu/view_uniforms.h"
#include "methods/shadow_planes/paper_stages.h"

namespace airlight::gpu::shadow_planes {

using airlight::shadow_planes::Options;

LitPicture::LitPicture(Frame& frame, const scene::View& v, bool hits, bool crossings, int dispatches)
    : view(v),
      distances(hits ? &frame.buffers.get("distances", std::size_t(v.width) * v.height * 4) : nullptr),
      primitives(hits ? &frame.buffers.get("primitives", std::size_t(v.width) * v.height * 4) : nullptr),
      pixels(frame.buffers.get("light of pixels", sizeof(LitPixelData) * v.width * v.height)),
      states(
          frame.buffers.get("states of pixels", sizeof(StateData) * (crossings ? std::size_t(v.width) * v.height : 1))),
      counters(frame.buffers.get("counters", sizeof(CountersData) + 16 * std::size_t(dispatches))) {
  counters.clear();
}

namespace {

bool any_sphere(const scene::Scene& scene) {
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end(), [](const scene::Surface& surface) {
    return std::holds_alternative<scene::Sphere>(surface.shape);
  });
}

}  // namespace

PlaneShading::PlaneShading(Context& context, const std::shared_ptr<const scene::Scene>& scene, const Options& options,
                           const AirlightTermsOnDevice& airlight_terms, const SurfacesOnDevice* surfaces)
    : context_(context),
      scene_(scene),
      options_(options),
      airlight_terms_(airlight_terms),
      surfaces_(surfaces),
      spheres_(any_sphere(*scene)),
      // llvmpipe's limit on loops is that of a dispatch.
      most_gatherings_(context.software() ? 4 : 128),
      materials_(context, "materials", MaterialTables(*scene).materials),
      tables_(context, "reflectance tables", MaterialTables(*scene).values),
      left_out_(program(context, "left_out", edges_per_group)),
      composition_(program(context, "composition", 8, 8,
                           {{"MOST_MEDIA", std::to_string(room_for_media(scene->media.size()))}})) {}

// Marks edges whose planes cannot cut a medium's box.
void PlaneShading::leave_out(const LightEdges& edges, const Box& box, const Point3& light) const {
  edges.bind();
  left_out_.set_double("box_lo", Vec3(box.lo - light));
  left_out_.set_double("box_hi", Vec3(box.hi - light));
  edges.dispatch(left_out_);
}

// Values at vertices are drawn by the paper's stages, with or without shadows.
bool PlaneShading::in_stages(int term, const Edges& lists, const VertexValues* values) const {
  return term >= 0 && (values || (options_.shadows == Options::Shadows::stencil && lists.edges));
}

Program& PlaneShading::shade_program(int light, int term, const LitPicture& picture, bool crossings,
                                     bool values) const {
  const bool parallel = picture.view.camera.kind != scene::Camera::Kind::perspective && crossings;
  const bool spot = std::holds_alternative<scene::SpotLight>(scene_->lights[light]);
  Program*& p = programs_[{spot, term, parallel, crossings, values}];
  if (p) return *p;
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const bool stages = term >= 0 && (values || (options_.shadows == Options::Shadows::stencil && crossings));
  auto definitions = airlight_terms_.definitions(light, term);
  definitions.insert({{"AIRLIGHT", flag(term >= 0)},
                      {"COUNT_BY_PIXEL", flag(parallel)},
                      {"CROSSINGS", flag(crossings)},
                      {"SHADOWS", std::to_string(int(options_.shadows))},
                      {"SPHERES", flag(spheres_)},
                      {"STENCIL", flag(stages)},
                      {"SURFACES", flag(!scene_->surfaces.empty())},
                      {"VERTICES", flag(values)}});
  p = &program(context_, "shade", 8, 8, definitions);
  return *p;
}

void PlaneShading::add(LitPicture& picture, int index, int term, const Edges& lists, const VertexValues* values,
                       int rounds) const {
  const Use use(context_);
  const scene::Light& light = scene_->lights[index];
  const auto* spot = std::get_if<scene::SpotLight>(&light);
  const bool stages = in_stages(term, lists, values);
  Program& p = shade_program(index, term, picture, lists.edges, values);
  if (const scene::Region* region = stages ? airlight_terms_.region(term) : nullptr) {
    if (lists.edges) leave_out(*lists.edges, bounding_box(*region), scene::ball(light)->center);
    p.set("boundary_cells", options_.boundary_cells);
  }
  airlight_terms_.bind(p, index, term);
  if (values) {
    values->bind(p);
    p.set("media_end", airlight::shadow_planes::all_end(scene_->media));
  }
  if (lists.edges) {
    lists.edges->bind();
    lists.fan->bind(p);
  }
  if (picture.primitives) picture.primitives->bind(at::primitives);
  if (surfaces_) surfaces_->bind();
  materials_.bind(at::materials);
  picture.pixels.bind(at::pixels);
  picture.states.bind(at::states);
  tables_.bind(at::tables);
  picture.counters.bind(at::counters);
  set_view(p, picture.view);
  p.set("intensity", spot ? spot->intensity : std::get<scene::PointLight>(light).intensity);
  p.set("triangle_count", surfaces_ ? surfaces_->triangles() : 0);
  p.set("solid_count", surfaces_ ? int(surfaces_->solids().size()) : 0);
  p.set("has_primitives", picture.primitives != nullptr);
  p.set("reflects", term <= 0);
  p.set("adds", !picture.empty);
  p.set("edge_split", options_.edge_split);
  p.set("frame_buffer", options_.frame_buffer && stages);
  p.set("most_gatherings", most_gatherings_);
  p.set("loop_count", 3);
  picture.empty = false;
  for (int round = 0; round <= rounds; ++round) {
    p.set("resume", round > 0);
    p.set("next_groups", round < rounds ? picture.next_groups : 0);
    if (round == 0)
      p.dispatch(picture.view.width, picture.view.height);
    else
      p.dispatch_indirect(picture.counters,
                          offsetof(CountersData, unfinished) + 16 * std::size_t(picture.next_groups - 1));
    if (round < rounds) ++picture.next_groups;
  }
}

void PlaneShading::compose(const LitPicture& picture, Frame& frame, const std::optional<Rgb>& ambient) const {
  const Use use(context_);
  Program& p = composition_;
  if (picture.distances) picture.distances->bind(at::distances);
  picture.pixels.bind(at::pixels);
  airlight_terms_.bind_media(p);
  bind_film_layers(frame, std::size_t(picture.view.width) * std::size_t(picture.view.height), p,
                   {at::mean_layer, at::transmittance_layer, at::surface_layer, at::airlight_layer, at::ambient_layer},
                   {true, ambient});
  set_view(p, picture.view);
  p.set("has_distances", picture.distances != nullptr);
  p.set("lights", !picture.empty);
  p.dispatch(picture.view.width, picture.view.height);
}

}  // namespace airlight::gpu::shadow_planes
