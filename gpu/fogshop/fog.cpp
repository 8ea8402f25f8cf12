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

// Packs all lights; `map_of_light` says where the map of each lies.
std::vector<LightData> light_data(const airlight::fogshop::Model& model, bool maps,
                                  const std::vector<int>& map_of_light) {
  std::vector<LightData> data;
  for (std::size_t l = 0; l < model.lights.size(); ++l) {
    const airlight::fogshop::LightModel& light = model.lights[l];
    const airlight::fogshop::MapFrame frame =
        maps ? airlight::fogshop::frame_of(model.gaussians, light.position) : airlight::fogshop::MapFrame{};
    data.push_back({float3(light.position), float(frame.near), float3(light.intensity.matrix()), float(frame.far),
                    float3(frame.axes.row(0)), float(frame.tangent), float3(frame.axes.row(1)),
                    int(std::size_t(map_of_light[l]) * map_values(model.options)), float3(frame.axes.row(2)), 0});
  }
  data.resize(room_for_lights(data.size()));  // as many as the block has
  return data;
}

// Difference between F and its limit, see f_table.glsl; empty where Eq. 17 is evaluated without the table.
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
    : context_(context), model_(model), needs_(needs) {
  become(needs, {});
}

void FogOnDevice::become(const airlight::fogshop::Needs& needs, const airlight::fogshop::Unchanged& same) {
  const Use use_context(context_);
  needs_ = needs;
  const std::size_t count = std::size_t(model_.gaussians.count), lights = model_.lights.size();
  if (!same.gaussians || !gaussians_) refill(gaussians_, context_, "Gaussians", gaussian_data(model_.gaussians));
  if (!tables_ || (!same.fog && model_.gaussians.has_colours()))
    refill(tables_, context_, "tables of the fog", tables());
  reserve(maps_, context_, "light maps", needs.light_maps ? map_values(model_.options) * lights * 4 : 0);
  const bool lost =
      reserve(depths_, context_, "depths to centres", needs.center_depths ? (count * (lights + 1) + lights) * 4 : 0);
  if (lost || !same.fog) depth_is_from_.assign(lights, std::nullopt);
  place_maps(same.gaussians);
  const std::vector<LightData> data = light_data(model_, needs.light_maps, map_of_light_);
  const auto* bytes = reinterpret_cast<const char*>(data.data());
  if (std::vector<char> now(bytes, bytes + data.size() * sizeof(LightData)); now != lights_uploaded_) {
    refill(lights_, context_, "lights", data);
    lights_uploaded_ = std::move(now);
  }
  if (!same.gaussians || !same.fog) make_programs();  // loops over Gaussians may be too long now
}

// A light keeps its map where it stands still, whatever its number is now; the others share the places that are left.
void FogOnDevice::place_maps(bool keeps) {
  const std::size_t count = model_.lights.size();
  if (!keeps) map_is_from_.clear();
  map_is_from_.resize(count);
  map_of_light_.assign(count, -1);
  std::vector<bool> taken(count);
  for (std::size_t l = 0; l < count; ++l)
    for (std::size_t place = 0; place < count && map_of_light_[l] < 0; ++place)
      if (!taken[place] && map_is_from_[place] == model_.lights[l].position) {
        map_of_light_[l] = int(place);
        taken[place] = true;
      }
  for (int& place : map_of_light_) {
    if (place >= 0) continue;
    place = int(std::find(taken.begin(), taken.end(), false) - taken.begin());
    taken[std::size_t(place)] = true;
    map_is_from_[std::size_t(place)].reset();
  }
}

bool is_like(const airlight::fogshop::Model& a, const airlight::fogshop::Needs& needs_of_a,
             const airlight::fogshop::Model& b, const airlight::fogshop::Needs& needs_of_b) {
  return needs_of_a == needs_of_b && a.lights.size() == b.lights.size() &&
         a.scattered_lights() == b.scattered_lights() && a.clear_ways == b.clear_ways &&
         a.options.map == b.options.map && (a.noise != nullptr) == (b.noise != nullptr) &&
         a.fog.one_albedo() == b.fog.one_albedo() && (a.gaussians.count > 0) == (b.gaussians.count > 0);
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
  definitions["MOST_LIGHTS"] = std::to_string(room_for_lights(model_.lights.size()));
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
  gaussians_->bind(at::gaussians);
  lights_->bind_as(GL_UNIFORM_BUFFER, at::lights);
  maps_->bind(at::light_maps);
  depths_->bind(at::depths);
  tables_->bind(at::fog_tables);
}

int FogOnDevice::fill_light_maps() {
  const auto missing = [&](int place) { return !map_is_from_[std::size_t(place)]; };
  const int made = int(std::count_if(map_of_light_.begin(), map_of_light_.end(), missing));
  if (made == 0) return 0;
  const Use use_context(context_);
  bind();
  Program& p = program("fogshop/light_map.comp", {{"LOCAL_SIZE_X", "8"}, {"LOCAL_SIZE_Y", "8"}});
  use(p);
  p.set("map_directions", model_.options.map_directions);
  p.set("map_edges", model_.options.map_edges);
  check_iterations(context_, (model_.options.map_edges / 8 + 1.0) * (model_.gaussians.count + 17), "a light map");
  for (std::size_t l = 0; l < model_.lights.size(); ++l) {
    if (!missing(map_of_light_[l])) continue;
    p.set("light_index", int(l));
    p.dispatch(model_.options.map_directions + 2, model_.options.map_directions + 2);
    map_is_from_[std::size_t(map_of_light_[l])] = model_.lights[l].position;
  }
  return made;
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

int FogOnDevice::fill_light_depths() {
  const Use use_context(context_);
  int filled = 0;
  for (std::size_t l = 0; l < model_.lights.size(); ++l) {
    const Point3& from = model_.lights[l].position;
    if (depth_is_from_[l] == from) continue;
    fill_depths(*programs_.view_depths, from, l * std::size_t(model_.gaussians.count), false);
    depth_is_from_[l] = from;
    ++filled;
  }
  return filled;
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

void FogOnDevice::compose(const scene::View& view, const Buffer* pixels, const Buffer* surface, const Buffer* seen,
                          Frame& frame) {
  const Use use_context(context_);
  frame.timer.begin("composition");
  Program& p = *programs_.composition;
  use(p);
  bind();
  if (pixels) pixels->bind(at::pixels);
  if (surface) surface->bind(at::surface);
  if (seen) seen->bind(at::seen);
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
  p.set("has_seen", seen != nullptr);
  p.set("pixel_count", count);
  p.dispatch(count);
}

}  // namespace airlight::gpu::fogshop
