#include "gpu/ray_marcher/device_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/ray_marcher/scene_data.h"
#include "gpu/view_uniforms.h"
#include "scene/error.h"

namespace airlight::gpu {
namespace {

constexpr int tile = 8;                                    // pixels, to both sides; a tile is a work group
constexpr std::size_t band_bytes = std::size_t(32) << 20;  // of the pixels that are on the device at once
constexpr double first_tiles = 16;                         // of the first dispatch
// Iterations of loops that an invocation does in a dispatch, about. llvmpipe ends all loops of eight invocations
// together after 65535 iterations, silently; on a GPU what counts is that a dispatch does not last.
constexpr int software_budget = 3000, budget = 100000;
// Of all invocations of a dispatch, about, in units of 256: a tenth of a second or less.
constexpr double software_aim = 4e6 / 256, aim = 2e9 / 256;
constexpr double software_most = 65535;
constexpr float far_away = 1e37f;  // as layer.glsl

template <class Has>
bool any_layer(const ray_marcher::Plan& plan, Has has) {
  return std::any_of(plan.layers.begin(), plan.layers.end(), has);
}

// Iterations of loops between two places where a march may stop and go on later: one light at one step.
double iterations_at_once(const ray_marcher::Plan& plan) {
  const ray_marcher::Options& o = plan.options;
  double sum = 0;
  for (const ray_marcher::Layer& layer : plan.layers) {
    if (!layer.varies) continue;
    const double across = bounding_box(layer.varied).size().norm(), most = double(1 << 20);
    const double steps = o.shadow_step > 0 ? std::min(across / o.shadow_step, most) : o.shadow_steps;
    // Divided steps (deep_column): 20 / deepest of them on the way into the dark, twice for the halves, and the way
    // back up.
    if (!o.exact_shadow && layer.most_varied * layer.thickest * across / steps > deepest_shadow_step(o))
      sum += 4 * 20 / deepest_shadow_step(o) * (layer.gaussians ? 3 * double(layer.gaussians->count) : 1);
    if (!layer.gaussians)
      sum += steps;
    else if (layer.gaussians->any_negative)
      sum += steps * double(layer.gaussians->count);
    else
      sum += double(layer.gaussians->count) * (o.exact_shadow ? 1 : 1 + steps / 4);
  }
  return sum;
}

}  // namespace

PlanOnDevice::PlanOnDevice(Context& context, const ray_marcher::Plan& plan, GridStorage storage)
    : context_(context),
      plan_(plan),
      middle_(middle_of(plan)),
      balls_(int(std::count_if(plan.lights.begin(), plan.lights.end(), [](const auto& l) { return bool(ball(l)); }))),
      has_occluders_(plan.scene->geometry && plan.scatters),
      occluders_(has_occluders_ ? make_occluders(plan.scene->surfaces, middle_) : Occluders{}),
      grids_(context, plan, storage),
      layers_(context, "layers", layer_data(plan, middle_, grids_.textures() > 0)),
      gaussians_(context, "Gaussians", gaussian_data(plan)),
      bricks_(context, "maps of empty space", brick_data(plan)),
      lights_(context, "lights", light_data(plan, middle_)),
      nodes_(context, "boxes of surfaces", occluders_.nodes),
      triangles_(context, "triangles", occluders_.triangles),
      solids_(context, "spheres and planes", occluders_.solids) {}

Program& PlanOnDevice::program(const scene::View& view) {
  const ray_marcher::Options& o = plan_.options;
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  Program& p = context_.program("ray_marcher/march.comp",
                                {{"LOCAL_SIZE_X", std::to_string(tile)},
                                 {"LOCAL_SIZE_Y", std::to_string(tile)},
                                 {"LAYERS", std::to_string(plan_.layers.size())},
                                 {"GRIDS", flag(any_layer(plan_, [](const auto& l) { return bool(l.grid); }))},
                                 {"TEXTURES", std::to_string(grids_.textures())},
                                 {"GAUSSIANS", flag(any_layer(plan_, [](const auto& l) { return bool(l.gaussians); }))},
                                 {"SKIP", flag(o.skip_empty)},
                                 {"GRADED", flag(o.graded)},
                                 {"EXACT_SHADOW", flag(o.exact_shadow)},
                                 {"OCCLUDERS", flag(has_occluders_)},
                                 {"BALL_WORDS", std::to_string(balls_ / 32 + 1)}});
  p.set("node_count", int(occluders_.nodes.size()));
  p.set("solid_count", int(occluders_.solids.size()));
  p.set("light_count", plan_.scatters ? int(plan_.lights.size()) : 0);
  p.set("balls", plan_.scatters ? balls_ : 0);
  p.set("graded", o.graded);
  p.set("skip_empty", o.skip_empty);
  p.set("exact_shadow", o.exact_shadow);
  p.set("steps", o.steps);
  p.set("step_length", o.step);
  p.set("shadow_steps", o.shadow_steps);
  p.set("shadow_step", o.shadow_step);
  p.set("horizon", o.horizon);
  p.set("deepest_step", deepest_step(o));
  p.set("deepest_shadow_step", deepest_shadow_step(o));
  p.set("darkest", o.early_exit > 0 ? float(-std::log(o.early_exit)) : far_away);
  set_camera(p, view, middle_);
  return p;
}

std::vector<MarchedPixel> PlanOnDevice::march(const scene::View& view, const Buffer* distances,
                                              const scene::Execution& execution, StageTimer& timer) {
  const Use use(context_);
  if (context_.software() && iterations_at_once(plan_) > software_most)
    throw Unavailable(
        fmt::format("gpu: a shadow ray may take {:.0f} iterations, {} stops after {:.0f}; expected fewer shadow steps",
                    iterations_at_once(plan_), context_.renderer(), software_most));
  Program& p = program(view);
  const int columns = (view.width + tile - 1) / tile;
  const std::size_t tile_row_bytes = std::size_t(columns) * tile * tile * sizeof(MarchedPixel);
  const int band = int(std::max<std::size_t>(1, band_bytes / tile_row_bytes)) * tile;
  layers_.bind(0);
  gaussians_.bind(1);
  grids_.bind();
  bricks_.bind(3);
  lights_.bind(4);
  nodes_.bind(7);
  triangles_.bind(8);
  solids_.bind(9);
  p.set("tile_columns", columns);
  p.set("has_distances", distances != nullptr);
  if (distances) distances->bind(5);

  p.set("budget", context_.software() ? software_budget : budget);
  Buffer progress(context_, "progress", 2 * sizeof(unsigned));
  progress.bind(10);

  // How many tiles a dispatch takes follows from the work that the last one did, not from the clock: dispatches are
  // counted, and the same picture takes the same number of them. No pixel depends on it.
  const double tiles = double(columns) * ((view.height + tile - 1) / tile);
  double tiles_at_once = first_tiles;
  std::vector<MarchedPixel> image;
  image.reserve(std::size_t(view.width) * view.height);
  for (int row = 0; row < view.height; row += band) {
    const int end_row = std::min(row + band, view.height);
    const std::size_t begin = std::size_t(row) * view.width, end = std::size_t(end_row) * view.width;
    const Buffer pixels(context_, "pixels", (end - begin) * sizeof(MarchedPixel));
    pixels.bind(6);
    p.set("first_row", row);
    const int end_tile = (end_row + tile - 1) / tile * columns;
    for (int first = row / tile * columns; first < end_tile;) {
      const int most = std::min(end_tile - first, context_.limits().groups[0]);
      const int count = std::clamp(int(std::min(tiles_at_once, 1e9)), 1, most);
      p.set("first_tile", first);
      for (bool done = false; !done;) {
        progress.upload(std::vector<unsigned>{0, 0});
        p.dispatch(count * tile, tile);
        const std::vector<unsigned> after = progress.download<unsigned>();
        done = after[0] == 0;
        const double wanted = context_.software() ? software_aim : aim;
        tiles_at_once = std::clamp(count * wanted / std::max(1u, after[1]), 1.0, 4.0 * count);
        if (execution.progress && !execution.progress((first + (done ? count : 0)) / tiles))
          throw scene::Interrupted("interrupted");
      }
      first += count;
    }
    timer.stage("march");
    const std::vector<MarchedPixel> strip = pixels.download<MarchedPixel>();
    image.insert(image.end(), strip.begin(), strip.end());
    timer.stage("read back");
  }
  return image;
}

}  // namespace airlight::gpu
