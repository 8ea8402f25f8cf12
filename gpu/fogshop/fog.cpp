#include "gpu/fogshop/fog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "gpu/fogshop/interface.h"
#include "scene/base/error.h"

namespace airlight::gpu::fogshop {
namespace {

using Float3 = std::array<float, 3>;
Float3 float3(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

std::vector<GaussianData> gaussian_data(const airlight::fogshop::GaussianArrays& g) {
  std::vector<GaussianData> data;
  for (int i = 0; i < g.count; ++i)
    data.push_back(
        {float3(g.center(i)), float(g.a[i]), float(g.half_depth[i]), float(g.radius_squared[i]), float(i), 0});
  return data;
}

// Three numbers each; empty where all albedos are equal.
std::vector<float> colours(const airlight::fogshop::GaussianArrays& g) {
  std::vector<float> data;
  for (int i = 0; i < g.count && g.has_colours(); ++i)
    for (int channel = 0; channel < 3; ++channel) data.push_back(float(g.colour[channel][i]));
  return data;
}

// Empty without noise.
std::vector<float> permutation(const airlight::fogshop::Model& model) {
  if (!model.noise) return {};
  return {model.noise->permutation().begin(), model.noise->permutation().end()};
}

std::size_t map_values(const airlight::fogshop::Options& o) {
  return std::size_t(o.map_directions + 2) * (o.map_directions + 2) * (o.map_edges + 1);
}

std::vector<LightData> light_data(const airlight::fogshop::Model& model, bool maps) {
  std::vector<LightData> data;
  for (std::size_t l = 0; l < model.lights.size(); ++l) {
    const airlight::fogshop::LightModel& light = model.lights[l];
    const airlight::fogshop::MapFrame frame =
        maps ? airlight::fogshop::frame_of(model.gaussians, light.position) : airlight::fogshop::MapFrame{};
    data.push_back({float3(light.position), float(frame.near), float3(light.intensity.matrix()), float(frame.far),
                    float3(frame.axes.row(0)), float(frame.tangent), float3(frame.axes.row(1)),
                    int(l * map_values(model.options)), float3(frame.axes.row(2)), 0});
  }
  data.resize(most_lights);  // as many as the block has
  return data;
}

// What F lacks to its limit, see f_table.glsl; empty where Eq. 17 does without the table.
std::vector<float> rest_of_f(const airlight::fogshop::Model& model, bool wanted, int& size) {
  std::vector<float> rest;
  if (!wanted) return rest;
  const airlight::fogshop::FTable table = model.f_table ? *model.f_table : airlight::fogshop::FTable();
  const std::vector<double>& values = table.values();
  size = table.size();
  for (std::size_t i = 0; i < values.size(); ++i) rest.push_back(float(values[i / size * size + size - 1] - values[i]));
  return rest;
}

}  // namespace

void check_iterations(const Context& context, double iterations, const char* what) {
  if (context.software() && iterations > most_iterations)
    throw Unavailable(fmt::format("gpu: {} takes about {:.0f} loop iterations, {} ends loops after 65535", what,
                                  iterations, context.renderer()));
}

FogOnDevice::FogOnDevice(Context& context, const airlight::fogshop::Model& model, const airlight::fogshop::Needs& needs)
    : context_(context),
      model_(model),
      needs_(needs),
      gaussians_(context, "Gaussians", gaussian_data(model.gaussians)),
      lights_(context, "lights", light_data(model, needs.light_maps)),
      maps_(context, "light maps", needs.light_maps ? map_values(model.options) * model.lights.size() * 4 : 0),
      depths_(context, "depths to centres",
              needs.center_depths
                  ? (std::size_t(model.gaussians.count) * (model.lights.size() + 1) + model.lights.size()) * 4
                  : 0),
      tables_(context, "tables of the fog", tables()) {
  const Use use_context(context_);
  make_programs();
}

std::vector<float> FogOnDevice::tables() {
  std::vector<float> all;
  const auto add = [&](const std::vector<float>& values) {
    const std::size_t from = all.size();
    all.insert(all.end(), values.begin(), values.end());
    return int(from);
  };
  table_places_.permutation = add(permutation(model_));
  table_places_.f = add(rest_of_f(model_, needs_.f_table, table_places_.f_size));
  table_places_.colours =
      add(colours(model_.gaussians));  // last: places are in the shaders, numbers of Gaussians are not
  return all;
}

Program& FogOnDevice::program(const char* file, Definitions definitions) const {
  if (model_.options.erf == airlight::fogshop::Erf::precise) {
    definitions["ERF_COUNT"] = "0";  // the shader's own, for single precision
  } else {
    const airlight::fogshop::ErfTable erf = airlight::fogshop::erf_table(model_.options.erf);
    std::vector<std::string> coefficients;
    for (const double c : erf.coefficients) coefficients.push_back(fmt::format("{:.9e}", c));
    definitions["ERF_CUT"] = fmt::format("{:.9e}", erf.cut);
    definitions["ERF_SCALE"] = fmt::format("{:.9e}", erf.scale);
    definitions["ERF_COUNT"] = std::to_string(coefficients.size());
    definitions["ERF_COEFFICIENTS"] = fmt::format("{}", fmt::join(coefficients, ", "));
  }
  definitions["F_TABLE"] = std::to_string(table_places_.f_size);
  definitions["COLOURS_FROM"] = std::to_string(table_places_.colours);
  definitions["PERMUTATION_FROM"] = std::to_string(table_places_.permutation);
  definitions["F_TABLE_FROM"] = std::to_string(table_places_.f);
  definitions.try_emplace("NOISE", "0");
  definitions["COLOURED"] = model_.fog.one_albedo() ? "0" : "1";
  return fogshop::program(context_, file, definitions);
}

void FogOnDevice::use(Program& p) const {
  if (!model_.fog.one_albedo()) p.set("constant_colour", model_.fog.constant_colour);
  p.set("gaussian_count", model_.gaussians.count);
  p.set("constant", model_.fog.sum.constant);
  p.set("extinction_ratio", model_.fog.extinction_ratio);
  p.set("phase_g", model_.fog.g);
  p.set("albedo", model_.fog.albedo);
}

void FogOnDevice::bind() const {
  gaussians_.bind(at::gaussians);
  lights_.bind_as(GL_UNIFORM_BUFFER, at::lights);
  maps_.bind(at::light_maps);
  depths_.bind(at::depths);
  tables_.bind(at::fog_tables);
}

void FogOnDevice::fill_light_maps() {
  const Use use_context(context_);
  bind();
  Program& p = program("fogshop/light_map.comp", {{"LOCAL_SIZE_X", "8"}, {"LOCAL_SIZE_Y", "8"}});
  use(p);
  p.set("map_directions", model_.options.map_directions);
  p.set("map_edges", model_.options.map_edges);
  check_iterations(context_, (model_.options.map_edges / 8 + 1.0) * (model_.gaussians.count + 17), "a light map");
  for (int l = 0; l < int(model_.lights.size()); ++l) {
    p.set("light_index", l);
    p.dispatch(model_.options.map_directions + 2, model_.options.map_directions + 2);
  }
}

// Depths between a point and every centre, one work group each; and between every light and the point.
void FogOnDevice::fill_depths(Program& p, const Point3& from, std::size_t first, bool lights_too) {
  const int targets = model_.gaussians.count + (lights_too ? int(model_.lights.size()) : 0);
  bind();
  use(p);
  p.set("from", Vec3(from));
  p.set("first_depth", int(first));
  p.set("target_count", targets);
  const int row = std::min(targets, 1 << 15);
  p.dispatch(depth_group * row, (targets + row - 1) / row);
}

void FogOnDevice::fill_light_depths() {
  const Use use_context(context_);
  for (std::size_t l = 0; l < model_.lights.size(); ++l)
    fill_depths(*programs_.view_depths, model_.lights[l].position, l * model_.gaussians.count, false);
}

void FogOnDevice::fill_view_depths(const Point3& view) {
  const Use use_context(context_);
  fill_depths(*programs_.view_depths, view, std::size_t(model_.gaussians.count) * model_.lights.size(), true);
}

float FogOnDevice::open_distance() const {
  const double d = model_.environment ? model_.options.environment_distance : infinity;
  return d < far_away ? float(d) : far_away;
}

void FogOnDevice::fill_sky_volume(const scene::Scene& scene, const scene::Execution& execution) {
  sky_ = std::make_unique<SkyVolumeOnDevice>(context_, *this, scene, model_, execution);
}

void FogOnDevice::compose(const scene::View& view, const Buffer* pixels, const Buffer* surface, Frame& frame) {
  const Use use_context(context_);
  frame.timer.begin("composition");
  Program& p = *programs_.composition;
  use(p);
  bind();
  if (pixels) pixels->bind(at::pixels);
  if (surface) surface->bind(at::surface);
  const int count = view.width * view.height;
  for (const auto& [layer, binding] : {std::pair{"airlight", at::airlight_layer},
                                       {"transmittance", at::transmittance_layer},
                                       {"mean", at::mean_layer}}) {
    Buffer& buffer = frame.buffers.get(layer, std::size_t(count) * 12);
    buffer.bind(binding);
    frame.download.add(layer, buffer, buffer.bytes());
  }
  p.set("has_airlight", pixels != nullptr);
  p.set("has_surface", surface != nullptr);
  p.set("pixel_count", count);
  p.dispatch(count);
}

}  // namespace airlight::gpu::fogshop
