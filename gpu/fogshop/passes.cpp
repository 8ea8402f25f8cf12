#include "gpu/fogshop/passes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gpu/view_uniforms.h"
#include "scene/error.h"

namespace airlight::gpu {
namespace {

constexpr int tile = 8;                                    // pixels, to both sides; a tile is a work group
constexpr std::size_t list_bytes = std::size_t(64) << 20;  // of the tiles' lists in one strip
const std::map<std::string, std::string> square = {{"LOCAL_SIZE_X", std::to_string(tile)},
                                                   {"LOCAL_SIZE_Y", std::to_string(tile)}};

using Float3 = std::array<float, 3>;
Float3 float3(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

// The layouts of fog.glsl, light.glsl, depths.comp.
struct GaussianData {
  Float3 center;
  float a, half_depth, radius_squared, place, unused;
};
struct LightData {
  Float3 position;
  float map_near;
  Float3 intensity;
  float map_far;
  Float3 axis_x;
  float map_tangent;
  Float3 axis_y;
  int map_offset;
  Float3 axis_z;
  float unused;
};

std::vector<GaussianData> gaussian_data(const fogshop::GaussianArrays& g) {
  std::vector<GaussianData> data;
  for (int i = 0; i < g.count; ++i)
    data.push_back(
        {float3(g.center(i)), float(g.a[i]), float(g.half_depth[i]), float(g.radius_squared[i]), float(i), 0});
  return data;
}

// Empty where all albedos are equal.
std::vector<std::array<float, 4>> colour_data(const fogshop::GaussianArrays& g) {
  std::vector<std::array<float, 4>> data;
  for (int i = 0; i < g.count && g.has_colours(); ++i)
    data.push_back({float(g.colour[0][i]), float(g.colour[1][i]), float(g.colour[2][i]), 0});
  return data;
}

// Empty without noise.
std::vector<int> permutation(const fogshop::Model& model) {
  if (!model.noise) return {};
  return {model.noise->permutation().begin(), model.noise->permutation().end()};
}

std::size_t map_values(const fogshop::Options& o) {
  return std::size_t(o.map_directions + 2) * (o.map_directions + 2) * (o.map_edges + 1);
}

bool has_maps(const fogshop::Model& model) { return !model.paper() && model.options.map && model.gaussians.count > 0; }

std::vector<LightData> light_data(const fogshop::Model& model) {
  std::vector<LightData> data;
  for (std::size_t l = 0; l < model.lights.size(); ++l) {
    const fogshop::LightModel& light = model.lights[l];
    const fogshop::MapFrame frame =
        has_maps(model) ? fogshop::frame_of(model.gaussians, light.position) : fogshop::MapFrame{};
    data.push_back({float3(light.position), float(frame.near), float3(light.intensity.matrix()), float(frame.far),
                    float3(frame.axes.row(0)), float(frame.tangent), float3(frame.axes.row(1)),
                    int(l * map_values(model.options)), float3(frame.axes.row(2)), 0});
  }
  return data;
}

}  // namespace

struct Segment {
  Float3 from;
  int without;
  Float3 to;
  float constant_part;
};

FogOnDevice::FogOnDevice(Context& context, const fogshop::Model& model)
    : context_(context),
      model_(model),
      gaussians_(context, "Gaussians", gaussian_data(model.gaussians)),
      lights_(context, "lights", light_data(model)),
      maps_(context, "light maps", has_maps(model) ? map_values(model.options) * model.lights.size() * 4 : 0),
      depths_(context, "depths to centres",
              model.paper() ? (std::size_t(model.gaussians.count) * (model.lights.size() + 1) + model.lights.size()) * 4
                            : 0),
      colours_(context, "colours", colour_data(model.gaussians)),
      permutation_(context, "permutation", permutation(model)) {}

Program& FogOnDevice::program(const char* file, std::map<std::string, std::string> definitions) {
  if (model_.options.erf == fogshop::Erf::precise) {
    definitions["ERF_COUNT"] = "0";  // the shader's own, for single precision
  } else {
    const fogshop::ErfTable erf = fogshop::erf_table(model_.options.erf);
    std::vector<std::string> coefficients;
    for (const double c : erf.coefficients) coefficients.push_back(fmt::format("{:.9e}", c));
    definitions["ERF_CUT"] = fmt::format("{:.9e}", erf.cut);
    definitions["ERF_SCALE"] = fmt::format("{:.9e}", erf.scale);
    definitions["ERF_COUNT"] = std::to_string(coefficients.size());
    definitions["ERF_COEFFICIENTS"] = fmt::format("{}", fmt::join(coefficients, ", "));
  }
  definitions["F_TABLE"] = std::to_string(f_table_size_);
  definitions["COLOURED"] = model_.fog.one_albedo() ? "0" : "1";
  Program& p = context_.program(file, definitions);
  if (!model_.fog.one_albedo()) p.set("constant_colour", model_.fog.constant_colour);
  p.set("gaussian_count", model_.gaussians.count);
  p.set("constant", model_.fog.sum.constant);
  p.set("hue", model_.fog.hue);
  p.set("albedo", model_.fog.albedo);
  return p;
}

void FogOnDevice::bind() const {
  gaussians_.bind(0);
  lights_.bind(4);
  maps_.bind(5);
  depths_.bind(8);
  if (!model_.fog.one_albedo()) colours_.bind(15);
  if (model_.noise) permutation_.bind(13);
  if (f_table_) f_table_->bind(14);
}

void check_iterations(const Context& context, double iterations, const char* what) {
  if (context.software() && iterations > most_iterations)
    throw Unavailable(fmt::format("gpu: {} takes about {:.0f} loop iterations, {} ends loops after 65535", what,
                                  iterations, context.renderer()));
}

void FogOnDevice::fill_light_maps() {
  const Use use(context_);
  bind();
  Program& p = program("fogshop/light_map.comp", {{"LOCAL_SIZE_X", "8"}, {"LOCAL_SIZE_Y", "8"}});
  p.set("map_directions", model_.options.map_directions);
  p.set("map_edges", model_.options.map_edges);
  check_iterations(context_, (model_.options.map_edges / 8 + 1.0) * (model_.gaussians.count + 17), "a light map");
  for (int l = 0; l < int(model_.lights.size()); ++l) {
    p.set("light_index", l);
    p.dispatch(model_.options.map_directions + 2, model_.options.map_directions + 2);
  }
}

void FogOnDevice::fill_depths(const std::vector<Segment>& segments, std::size_t first) {
  if (segments.empty()) return;
  check_iterations(context_, model_.gaussians.count, "depths to centres");
  const Use use(context_);
  const Buffer input(context_, "segments", segments);
  bind();
  input.bind(7);
  Program& p = program("fogshop/depths.comp", {{"LOCAL_SIZE_X", "64"}});
  p.set("segment_count", int(segments.size()));
  p.set("first_depth", int(first));
  p.dispatch(int(segments.size()));
}

void FogOnDevice::fill_light_depths() {
  std::vector<Segment> segments;
  for (const fogshop::LightModel& light : model_.lights)
    for (int i = 0; i < model_.gaussians.count; ++i)
      segments.push_back({float3(light.position), i, float3(model_.gaussians.center(i)), 1});
  fill_depths(segments, 0);
}

void FogOnDevice::fill_view_depths(const Point3& view) {
  std::vector<Segment> segments;
  for (int i = 0; i < model_.gaussians.count; ++i)
    segments.push_back({float3(view), i, float3(model_.gaussians.center(i)), 1});
  for (const fogshop::LightModel& light : model_.lights)
    segments.push_back({float3(light.position), -1, float3(view), 0});
  fill_depths(segments, std::size_t(model_.gaussians.count) * model_.lights.size());
}

float FogOnDevice::open_distance() const {
  const double d = model_.environment ? model_.options.environment_distance : infinity;
  return d < far_away ? float(d) : far_away;
}

void FogOnDevice::fill_sky_volume(const scene::Scene& scene) {
  sky_ = std::make_unique<SkyVolumeOnDevice>(context_, *this, scene, model_);
}

void FogOnDevice::upload_f_table(const fogshop::FTable& table) {
  const Use use(context_);
  const std::vector<double>& values = table.values();
  const std::size_t size = table.size();
  std::vector<float> rest;  // see f_table.glsl
  for (std::size_t i = 0; i < values.size(); ++i) rest.push_back(float(values[i / size * size + size - 1] - values[i]));
  f_table_ = std::make_unique<Buffer>(context_, "table of F", rest);
  f_table_size_ = table.size();
}

void FogOnDevice::compute(const scene::View& view, int step, bool has_distances, bool only_edges, StageTimer& timer) {
  const fogshop::Options& o = model_.options;
  const int n = model_.gaussians.count, lights = int(model_.lights.size());
  const int width = (view.width + step - 1) / step, height = (view.height + step - 1) / step;
  const std::string stage = only_edges ? "edges at full resolution" : "airlight";
  const auto prepare = [&](Program& p) {
    set_camera(p, view);
    p.set("grid_width", width);
    p.set("grid_height", height);
    p.set("film_step", step);
    p.set("only_edges", only_edges);
    p.set("open_distance", open_distance());
  };
  if (n == 0) {
    Program& p = program("fogshop/homogeneous.comp", square);
    prepare(p);
    p.set("has_distances", has_distances);
    p.set("light_count", lights);
    p.set("source_radius", o.source_radius);
    p.dispatch(width, height);
    timer.stage(stage);
    return;
  }

  const int columns = (width + tile - 1) / tile, rows = (height + tile - 1) / tile;
  const std::size_t row_bytes = std::size_t(columns) * n * 4;
  const int strip =
      int(std::clamp<std::size_t>(std::min(list_bytes, context_.limits().storage_block) / row_bytes, 1, rows));
  const Buffer counts(context_, "tile counts", std::size_t(strip) * columns * 4);
  const Buffer lists(context_, "tile lists", std::size_t(strip) * row_bytes);
  counts.bind(1);
  lists.bind(2);
  Program& tiles = program("fogshop/tiles.comp", {{"LOCAL_SIZE_X", "64"}, {"TILE", std::to_string(tile)}});
  auto definitions = square;
  definitions["LIGHTS"] = std::to_string(lights);
  if (!model_.paper()) {
    definitions["K"] = std::to_string(o.slices);
    definitions["EXACT_LIGHT_DEPTH"] = o.map ? "0" : "1";
  }
  definitions["NOISE"] = model_.noise ? "1" : "0";
  Program& p = program(model_.paper() ? "fogshop/paper.comp" : "fogshop/slices.comp", definitions);
  const auto set_noise = [&](Program& p) {
    if (!model_.noise) return;
    p.set("noise_scale", model_.noise->scale());
    p.set("noise_frequency", model_.noise->frequency());
    // Whole periods are nothing, and would cost digits.
    p.set("noise_phase", std::remainder(model_.noise->phase(), double(fogshop::Noise::period)));
    p.set("noise_reach", fogshop::noise_reach(model_.noise->scale()));
  };
  set_noise(p);
  prepare(tiles);
  prepare(p);
  p.set("has_distances", has_distances);
  p.set("source_radius", o.source_radius);
  if (!model_.paper()) {
    p.set("boxes", o.boxes);
    p.set("extrapolate", o.extrapolate);
    p.set("clearest", float((model_.fog.hue > 0).select(model_.fog.hue, 1.0).minCoeff()));
    p.set("map_directions", o.map_directions);
    p.set("map_edges", o.map_edges);
  }
  Program* sky = nullptr;
  if (sky_) {
    auto of_sky = square;
    of_sky["K"] = std::to_string(o.slices);
    of_sky["NOISE"] = definitions["NOISE"];
    sky = &program("fogshop/sky_light.comp", of_sky);
    prepare(*sky);
    set_noise(*sky);
    sky->set("has_distances", has_distances);
    sky_->use(*sky);
  }
  // Loop iterations of one invocation, for each Gaussian of its tile and apart from them.
  const double light_steps = lights > 0 ? std::max(8, o.slices / lights) : 0;
  const double each = model_.paper()
                          ? 1 + lights
                          : 3 + std::ceil((1.5 * o.slices + 1 + lights * light_steps) / 8) + std::ceil(o.slices / 8.0);
  const double apart = model_.paper() ? 0 : lights * (10.0 * o.slices + (o.map ? 0.0 : (o.slices + 1.0) * n));
  for (int first = 0; first < rows; first += strip) {
    const int count = std::min(strip, rows - first);
    tiles.set("tile_row", first);
    tiles.set("tile_rows", count);
    tiles.set("tile_columns", columns);
    tiles.dispatch(columns * count);
    const auto watch = [&](double each, double apart, const char* what) {
      if (!context_.software() || each * n + apart <= most_iterations) return;
      const std::vector<int> near = counts.download<int>();
      const int most = *std::max_element(near.begin(), near.begin() + columns * count);
      check_iterations(context_, each * most + apart, what);
    };
    watch(each, apart, model_.paper() ? "the paper's airlight" : "the airlight by slices");
    if (sky) watch(2 + std::ceil(o.slices / 8.0), 10.0 * o.slices, "the environment's airlight by slices");
    timer.stage("tiles");
    p.set("tile_row", first);
    p.dispatch(columns * tile, count * tile);
    timer.stage(stage);
    if (sky) {
      sky->set("tile_row", first);
      sky->dispatch(columns * tile, count * tile);
      timer.stage("environment");
    }
  }
}

std::unique_ptr<Buffer> FogOnDevice::airlight(const scene::View& view, const Buffer* distances, StageTimer& timer) {
  const Use use(context_);
  auto pixels = std::make_unique<Buffer>(context_, "pixels", std::size_t(view.width) * view.height * 16);
  bind();
  if (distances) distances->bind(3);
  pixels->bind(6);
  compute(view, 1, distances != nullptr, false, timer);
  if (light_) add_environment(view, distances != nullptr, timer);
  return pixels;
}

std::unique_ptr<Buffer> FogOnDevice::low_resolution_airlight(const scene::View& view, const Buffer* distances,
                                                             const Buffer* low_distances, StageTimer& timer) {
  const Use use(context_);
  const fogshop::Options& o = model_.options;
  const fogshop::LowResolution r{view.width, view.height, o.downsample};
  const std::size_t count = std::size_t(view.width) * view.height;
  const bool has_distances = distances != nullptr,
             find_edges = has_distances && o.upsample != fogshop::Options::Upsample::bilinear;
  auto pixels = std::make_unique<Buffer>(context_, "pixels", count * 16);
  const Buffer low(context_, "low pixels", std::size_t(r.low_width()) * r.low_height() * 16);
  const Buffer edges(context_, "edges", find_edges ? count * 4 : 0);
  bind();
  edges.bind(9);
  if (low_distances) low_distances->bind(3);
  low.bind(6);
  compute(view, r.factor, has_distances, false, timer);

  if (distances) distances->bind(3);
  pixels->bind(6);
  low.bind(10);
  if (low_distances) low_distances->bind(11);
  Program& p = context_.program("fogshop/upsample.comp", square);
  p.set("width", r.width);
  p.set("height", r.height);
  p.set("low_width", r.low_width());
  p.set("low_height", r.low_height());
  p.set("factor", r.factor);
  p.set("find_edges", find_edges);
  p.set("open_distance", open_distance());
  p.dispatch(r.width, r.height);
  timer.stage("upsampling");
  if (find_edges && o.upsample == fogshop::Options::Upsample::recompute) compute(view, 1, true, true, timer);
  if (light_) add_environment(view, has_distances, timer);
  return pixels;
}

void FogOnDevice::compose(const Buffer* pixels, const Buffer* surface, const Buffer& airlight,
                          const Buffer& transmittance, const Buffer& mean) {
  const Use use(context_);
  Program& p = program("fogshop/composition.comp", {{"LOCAL_SIZE_X", "64"}});
  bind();
  if (pixels) pixels->bind(6);
  if (surface) surface->bind(7);
  airlight.bind(1);
  transmittance.bind(2);
  mean.bind(3);
  const int count = int(mean.bytes() / 12);
  p.set("has_airlight", pixels != nullptr);
  p.set("has_surface", surface != nullptr);
  p.set("pixel_count", count);
  p.dispatch(count);
}

}  // namespace airlight::gpu
