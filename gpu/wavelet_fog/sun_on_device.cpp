#include "gpu/wavelet_fog/sun_on_device.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "gpu/view_uniforms.h"
#include "methods/wavelet_fog/sun_scattering.h"
#include "scene/error.h"

namespace airlight::gpu::fogmaps {
namespace {

constexpr int tile = 8, most_iterations = 65535;

// What map and march read alike.
void set_rows(Program& p, const wavelet_fog::SunRows& rows, double step) {
  p.set("sun_columns", rows.columns);
  p.set("sun_rows", rows.rows);
  p.set_double("sun_along_u", rows.along[0]);
  p.set_double("sun_along_v", rows.along[1]);
  p.set_double("sun_lo_p", rows.lo[0]);
  p.set_double("sun_lo_q", rows.lo[1]);
  p.set_double("sun_step", step);
  p.set_double("sun_climb", rows.k);
}

}  // namespace

std::vector<const scene::DirectionalLight*> suns_of(const scene::Scene& scene) {
  std::vector<const scene::DirectionalLight*> suns;
  for (const scene::Light& light : scene.lights)
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light); sun && sun->irradiance.maxCoeff() > 0)
      suns.push_back(sun);
  return suns;
}

SunOnDevice::SunOnDevice(Context& context, FogOnDevice& fog, const wavelet_fog::Options& options)
    : context_(context), fog_(fog), options_(options) {
  Definitions definitions = fog.definitions();
  definitions["SKIPS"] = "1";
  const int points = std::max(options.sun_points, std::stoi(definitions.at("DEGREE")) + 1);
  const auto rule = wavelet_fog::SunScattering::rule_of(points);
  definitions["SUN_POINTS"] = std::to_string(points);
  definitions["SUN_NODES"] = listed(rule.node);
  definitions["SUN_WEIGHTS"] = listed(rule.weight);
  definitions["SUN_UPTO"] = listed(rule.upto);
  definitions["LEAST_WAY"] = fmt::format("{:e}LF", wavelet_fog::SunMap::least_way);
  // Cells that a ray may cross, an iteration each; pieces of a cell, halved where its depth changes by more than most_change of
  // sun.comp, twice as many for that of the way to the sun; in each a point, its lookup and its terms.
  const scene::Medium& medium = fog.medium();
  const scene::Fogmap& map = *std::get<scene::FogmapPointer>(medium.field);
  const bool falls =
      std::holds_alternative<scene::ExponentialFall>(map.profile);  // over 40 scale heights, pieces of one
  const double knots = double(height_breaks(map.profile).size());
  const double cells = map.map.range().size[0] + map.map.range().size[1] + 16 + (falls ? 80 : knots);
  const double depth = medium.sigma_t.maxCoeff() * greatest_density(medium.field) * 1.5 * map.cell;
  const double iterations = cells * (1 + 2 * std::max(1.0, 4 * depth) * points * (4 + knots + points));
  if (context.software() && iterations > most_iterations)
    throw Unavailable(
        fmt::format("gpu: sun takes up to {:.0f} iterations of loops for a ray in this fog, {} ends them after {}",
                    iterations, context.renderer(), most_iterations));
  scatter_ = &program(context, "sun", tile, tile, definitions);
  definitions["SKIPS"] = "0";
  steps_ = &program(context, "sun_steps", tile, tile, definitions);
  sums_ = &program(context, "sun_sums", 64);
}

void SunOnDevice::fill_map(const Vec3& to_sun, FrameBuffers& buffers, const Buffer& unused) {
  const scene::Fogmap& fog = *std::get<scene::FogmapPointer>(fog_.medium().field);
  const wavelet_fog::SunRows rows = wavelet_fog::rows_towards(fog, to_sun, options_.sun_step);
  set_rows(*scatter_, rows, options_.sun_step);
  if (rows.upright) {
    unused.bind(at::table);
    return;
  }
  // Rooms grow by powers of two, so that a sun that moves allocates next to nothing.
  const std::size_t bytes = 16 * std::size_t(rows.columns) * std::size_t(rows.rows);
  const Buffer& map =
      buffers.get("sun map", std::min(std::bit_ceil(bytes), std::max(bytes, context_.limits().storage_block)));
  map.bind(at::table);
  set_rows(*steps_, rows, options_.sun_step);
  steps_->dispatch(rows.columns, rows.rows);
  sums_->set("sun_columns", rows.columns);
  sums_->set("sun_rows", rows.rows);
  sums_->set("sun_step", options_.sun_step);
  sums_->set("fallen", std::exp(-rows.k * options_.sun_step));
  sums_->dispatch(rows.rows);
}

void SunOnDevice::render(const scene::Scene& scene, const scene::View& view, FrameBuffers& buffers,
                         const Buffer* distances, const Buffer& airlight, const Buffer& counters, bool counts) {
  const scene::Medium& medium = fog_.medium();
  Program& p = *scatter_;
  set_view(p, view);
  p.set("has_distances", distances != nullptr);
  p.set("counts", counts);
  p.set("loop_count", 3);
  p.set("least", float(std::max(options_.termination, std::exp(-40.0))));  // opaque in sun.comp
  p.set("phase_kind", int(medium.phase.index()));
  const auto* hg = std::get_if<scene::HenyeyGreenstein>(&medium.phase);
  p.set("phase_g", hg ? hg->g : 0.0);
  bool first = true;
  for (const scene::DirectionalLight* sun : suns_of(scene)) {
    fog_.bind();
    fill_map(sun->to_light, buffers, airlight);
    (distances ? *distances : airlight).bind(at::distances);
    airlight.bind(at::airlight);
    counters.bind(at::counters);
    p.set_double("sun_x", sun->to_light[0]);
    p.set_double("sun_y", sun->to_light[1]);
    p.set_double("sun_z", sun->to_light[2]);
    p.set("scattered", Rgb(medium.albedo * medium.sigma_t * sun->irradiance));
    p.set("first", first);
    first = false;
    p.dispatch(view.width, view.height);
  }
}

}  // namespace airlight::gpu::fogmaps
