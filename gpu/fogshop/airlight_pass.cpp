// Airlight of all pixels: lists of Gaussians by tile, then the passes of each variant, strip by strip.
#include <algorithm>
#include <cmath>

#include "gpu/fogshop/fog.h"
#include "gpu/fogshop/interface.h"
#include "gpu/view_uniforms.h"

namespace airlight::gpu::fogshop {
namespace {

constexpr int tile = 8;                                     // pixels, to both sides; a tile is a work group
constexpr int span = 8, gaussians_with_squares = 512;       // tiles of a square; fewer Gaussians need none
constexpr int nodes_each = 32, slices_each = 8;             // an invocation: shares.comp, slice_depths.comp
constexpr std::size_t strip_bytes = std::size_t(64) << 20;  // of the lists, and of what the passes of variant S hand on
const Definitions square = {{"LOCAL_SIZE_X", std::to_string(tile)}, {"LOCAL_SIZE_Y", std::to_string(tile)}};

int blocks(int count, int size) { return (count + size - 1) / size; }

// Sizes of fogshop/ray_values.glsl: nodes are even steps of the ray, and of the angle from each light.
struct RayValues {
  int slices, lights;
  int even_steps() const { return slices + slices / 2; }
  int light_steps() const { return lights > 0 ? std::max(8, slices / lights) : 0; }
  int nodes() const { return even_steps() + 1 + lights * light_steps(); }
  double iterations() const { return 2.0 * lights * (lights + nodes()); }  // of stretch.comp, to sort the nodes
  int fields() const { return 5 + slices + 1 + std::max(2 * nodes(), 4 * slices + 1); }
  void set(Program& p) const {
    p.set("slice_count", slices);
    p.set("node_count", nodes());
  }
};

Definitions with(Definitions all, const Definitions& more) {
  all.insert(more.begin(), more.end());
  return all;
}

}  // namespace

struct FogOnDevice::Strip {
  int first, rows, columns;  // tiles
};

void FogOnDevice::make_programs() {
  const airlight::fogshop::Options& o = model_.options;
  const int n = model_.gaussians.count, lights = model_.scattered_lights();
  programs_.composition = &program("fogshop/composition.comp", {{"LOCAL_SIZE_X", "64"}});
  if (needs_.center_depths)
    programs_.view_depths = &program("fogshop/depths.comp", {{"LOCAL_SIZE_X", std::to_string(depth_group)}});
  if (needs_.low_resolution) programs_.upsample = &program("fogshop/upsample.comp", square);
  if (!needs_.airlight) return;
  if (n == 0) {
    programs_.homogeneous = &program("fogshop/homogeneous.comp", square);
    return;
  }
  const bool squares = n > gaussians_with_squares;
  const Definitions spanned = with(square, {{"SPAN", std::to_string(squares ? span : 0)}});
  programs_.tiles = &program("fogshop/tiles.comp", spanned);
  programs_.squares = squares ? &program("fogshop/squares.comp", spanned) : nullptr;
  const Definitions noise = {{"NOISE", model_.noise ? "1" : "0"}};
  if (model_.paper()) {
    const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
    programs_.paper = &program("fogshop/paper.comp", with(with(square, noise), {{"SOME_LIGHTS", flag(lights > 0)},
                                                                                {"ONE_LIGHT", flag(lights == 1)},
                                                                                {"GREY", flag(model_.fog.grey())},
                                                                                {"PHASE", flag(model_.fog.g != 0)}}));
    check_iterations(context_, n * (1.0 + lights), "the paper's airlight");
  }
  if (model_.paper() && !needs_.sky_volume) return;
  const Definitions sizes = with(square, noise);
  programs_.stretch = &program(
      "fogshop/stretch.comp",
      with(sizes, {{"LIGHTS", std::to_string(model_.paper() ? 0 : lights)}, {"SKY", needs_.sky_volume ? "1" : "0"}}));
  if (sliced()) {
    programs_.shares = &program("fogshop/shares.comp", sizes);
    programs_.edges = &program("fogshop/edges.comp", sizes);
    programs_.slice_depths = &program("fogshop/slice_depths.comp", with(sizes, {{"EVEN", "0"}}));
    programs_.slice_light = &program("fogshop/slice_light.comp", with(sizes, {{"LIGHT_DEPTH", model_.clear_ways ? "0"
                                                                                              : o.map           ? "1"
                                                                                                      : "2"}}));
    // A Gaussian of the tile is one iteration in each pass.
    check_iterations(context_,
                     std::max({double(n) + RayValues{o.slices, lights}.iterations(),
                               lights * (o.slices + 1.0) * (o.map ? 10 : 10 + n)}),
                     "the airlight by slices");
  }
  if (needs_.sky_volume) {
    programs_.even_depths = &program("fogshop/slice_depths.comp", with(sizes, {{"EVEN", "1"}}));
    programs_.sky_light = &program("fogshop/sky_light.comp", sizes);
  }
}

void FogOnDevice::set_grid(Program& p, const Grid& grid) const {
  use(p);
  set_camera(p, grid.view);
  p.set("grid_width", grid.width());
  p.set("grid_height", grid.height());
  p.set("film_step", grid.step);
  p.set("has_distances", grid.has_distances);
  p.set("only_edges", grid.only_edges);
  p.set("open_distance", open_distance());
}

void FogOnDevice::set_noise(Program& p) const {
  if (!model_.noise) return;
  p.set("noise_scale", model_.noise->scale());
  p.set("noise_frequency", model_.noise->frequency());
  // Whole periods are nothing, and would cost digits.
  p.set("noise_phase", std::remainder(model_.noise->phase(), double(airlight::fogshop::Noise::period)));
  p.set("noise_reach", airlight::fogshop::noise_reach(model_.noise->scale()));
}

void FogOnDevice::compute(const Grid& grid, Frame& frame) {
  const airlight::fogshop::Options& o = model_.options;
  const char* const stage = grid.only_edges ? "edges at full resolution" : "airlight";
  if (programs_.homogeneous) {
    frame.timer.begin(stage);
    Program& p = *programs_.homogeneous;
    set_grid(p, grid);
    p.set("light_count", model_.scattered_lights());
    p.set("source_radius", o.source_radius);
    p.dispatch(grid.width(), grid.height());
    return;
  }
  const int columns = blocks(grid.width(), tile), rows = blocks(grid.height(), tile), n = model_.gaussians.count;
  const bool hands_on = sliced() || needs_.sky_volume;
  const RayValues values{o.slices, sliced() ? model_.scattered_lights() : 0};
  const int fields = hands_on ? values.fields() : 0;
  const std::size_t row_of_lists = std::size_t(columns) * (2 * n + 1) * 4,
                    row_of_rays = std::size_t(fields) * grid.width() * tile * 4;
  const std::size_t most = std::min(strip_bytes, context_.limits().storage_block);
  // Squares take an eighth of what their tiles take, or less.
  const int height =
      int(std::clamp<std::size_t>(most / std::max(row_of_lists + row_of_lists / span, row_of_rays), 1, rows));
  const std::string which = grid.only_edges ? " of edges" : "";  // both are kept where both are made
  const std::size_t squares = programs_.squares ? std::size_t(blocks(height, span)) * blocks(columns, span) : 0;
  frame.buffers.get("tile lists" + which, height * row_of_lists + squares * (2 * std::size_t(n) + 1) * 4)
      .bind(at::tile_lists);
  if (hands_on) frame.buffers.get("values of rays" + which, height * row_of_rays).bind(at::ray_values);
  for (Program* p : {programs_.squares, programs_.tiles, programs_.paper, programs_.stretch, programs_.shares,
                     programs_.slice_depths, programs_.slice_light, programs_.even_depths, programs_.sky_light})
    if (p) set_grid(*p, grid);
  for (Program* p :
       {programs_.paper, programs_.stretch, programs_.shares, programs_.slice_depths, programs_.even_depths})
    if (p) set_noise(*p);
  for (Program* p : {programs_.stretch, programs_.shares, programs_.edges, programs_.slice_depths,
                     programs_.slice_light, programs_.even_depths, programs_.sky_light})
    if (p) values.set(*p);
  for (Program* p : {programs_.paper, programs_.shares, programs_.slice_light})
    if (p) p->set("light_count", model_.scattered_lights());
  for (Program* p : {programs_.paper, programs_.slice_light})
    if (p) p->set("source_radius", o.source_radius);
  if (sliced()) {
    programs_.edges->set("grid_width", grid.width());
    programs_.edges->set("gaussian_count", n);
    programs_.shares->set("boxes", o.boxes);
    programs_.stretch->set("even_steps", values.even_steps());
    programs_.stretch->set("light_steps", values.light_steps());
    programs_.stretch->set(
        "clearest", float((model_.fog.extinction_ratio > 0).select(model_.fog.extinction_ratio, 1.0).minCoeff()));
    programs_.slice_light->set("extrapolate", o.extrapolate);
    programs_.slice_light->set("map_directions", o.map_directions);
    programs_.slice_light->set("map_edges", o.map_edges);
  }
  if (sky_) sky_->use(*programs_.sky_light);
  for (int first = 0; first < rows; first += height)
    compute_strip(grid, {first, std::min(height, rows - first), columns}, frame);
}

void FogOnDevice::compute_strip(const Grid& grid, const Strip& strip, Frame& frame) {
  const airlight::fogshop::Options& o = model_.options;
  const int width = strip.columns * tile, height = strip.rows * tile;
  const auto run = [&](Program* p, int blocks_of_each = 1) {
    p->set("tile_row", strip.first);
    if (p != programs_.tiles && p != programs_.paper) p->set("ray_count", grid.width() * height);
    p->dispatch(width, height, blocks_of_each);
  };
  frame.timer.begin("tiles");
  if (programs_.squares) {
    for (Program* p : {programs_.squares, programs_.tiles}) {
      p->set("squares_at", strip.rows * strip.columns * (2 * model_.gaussians.count + 1));
      p->set("squares_along", blocks(strip.columns, span));
    }
    programs_.squares->set("tile_row", strip.first);
    programs_.squares->dispatch(blocks(strip.columns, span) * tile, blocks(strip.rows, span) * tile);
  }
  run(programs_.tiles);
  frame.timer.begin(grid.only_edges ? "edges at full resolution" : "airlight");
  if (programs_.stretch) run(programs_.stretch);
  if (programs_.paper) run(programs_.paper);
  if (sliced()) {
    run(programs_.shares, blocks(RayValues{o.slices, model_.scattered_lights()}.nodes(), nodes_each));
    run(programs_.edges);
    run(programs_.slice_depths, blocks(o.slices, slices_each));
    run(programs_.slice_light);
  }
  if (!sky_) return;
  frame.timer.begin("environment");
  run(programs_.even_depths, blocks(o.slices, slices_each));
  run(programs_.sky_light);
}

const Buffer& FogOnDevice::airlight(const scene::View& view, const Buffer* distances, Frame& frame) {
  const Use use_context(context_);
  const Buffer& pixels = frame.buffers.get("pixels", std::size_t(view.width) * view.height * 16);
  bind();
  if (distances) distances->bind(at::distances);
  pixels.bind(at::pixels);
  compute({view, 1, distances != nullptr, false}, frame);
  if (light_) add_environment(view, distances != nullptr, frame);
  return pixels;
}

void FogOnDevice::upsample(const airlight::fogshop::LowResolution& r, bool find_edges) {
  Program& p = *programs_.upsample;
  p.set("width", r.width);
  p.set("height", r.height);
  p.set("low_width", r.low_width());
  p.set("low_height", r.low_height());
  p.set("factor", r.factor);
  p.set("find_edges", find_edges);
  p.set("open_distance", open_distance());
  p.dispatch(r.width, r.height);
}

const Buffer& FogOnDevice::low_resolution_airlight(const scene::View& view, const Buffer* distances,
                                                   const Buffer* low_distances, Frame& frame) {
  using Upsample = airlight::fogshop::Options::Upsample;
  const Use use_context(context_);
  const airlight::fogshop::Options& o = model_.options;
  const airlight::fogshop::LowResolution r{view.width, view.height, o.downsample};
  const std::size_t count = std::size_t(view.width) * view.height;
  const bool has_distances = distances != nullptr, find_edges = has_distances && o.upsample != Upsample::bilinear;
  const Buffer& pixels = frame.buffers.get("pixels", count * 16);
  const Buffer& low = frame.buffers.get("low pixels", std::size_t(r.low_width()) * r.low_height() * 16);
  bind();
  frame.buffers.get("edges", find_edges ? count * 4 : 0).bind(at::edges);
  if (low_distances) low_distances->bind(at::distances);
  low.bind(at::pixels);
  compute({view, r.factor, has_distances, false}, frame);

  frame.timer.begin("upsampling");
  if (distances) distances->bind(at::distances);
  pixels.bind(at::pixels);
  low.bind(at::low_pixels);
  if (low_distances) low_distances->bind(at::low_distances);
  upsample(r, find_edges);
  if (find_edges && o.upsample == Upsample::recompute) compute({view, 1, true, true}, frame);
  if (light_) add_environment(view, has_distances, frame);
  return pixels;
}

}  // namespace airlight::gpu::fogshop
