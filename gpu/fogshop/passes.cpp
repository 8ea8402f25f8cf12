#include "gpu/fogshop/passes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace airlight::gpu {
namespace {

constexpr int tile = 8;                                    // pixels, to both sides; a tile is a work group
constexpr std::size_t list_bytes = std::size_t(64) << 20;  // of the tiles' lists in one strip

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
                            : 0) {}

Program& FogOnDevice::program(const char* file, std::map<std::string, std::string> definitions) {
  const fogshop::ErfTable erf = fogshop::erf_table(model_.options.erf);
  std::vector<std::string> coefficients;
  for (const double c : erf.coefficients) coefficients.push_back(fmt::format("{:.9e}", c));
  definitions["ERF_CUT"] = fmt::format("{:.9e}", erf.cut);
  definitions["ERF_SCALE"] = fmt::format("{:.9e}", erf.scale);
  definitions["ERF_COUNT"] = std::to_string(coefficients.size());
  definitions["ERF_COEFFICIENTS"] = fmt::format("{}", fmt::join(coefficients, ", "));
  Program& p = context_.program(file, definitions);
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
}

void FogOnDevice::fill_light_maps() {
  const Use use(context_);
  bind();
  Program& p = program("fogshop/light_map.comp", {{"LOCAL_SIZE_X", "8"}, {"LOCAL_SIZE_Y", "8"}});
  p.set("map_directions", model_.options.map_directions);
  p.set("map_edges", model_.options.map_edges);
  for (int l = 0; l < int(model_.lights.size()); ++l) {
    p.set("light_index", l);
    p.dispatch(model_.options.map_directions + 2, model_.options.map_directions + 2);
  }
}

void FogOnDevice::fill_depths(const std::vector<Segment>& segments, std::size_t first) {
  if (segments.empty()) return;
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

std::unique_ptr<Buffer> FogOnDevice::airlight(const scene::View& view, const Buffer* distances, StageTimer& timer) {
  const Use use(context_);
  const fogshop::Options& o = model_.options;
  const int n = model_.gaussians.count, lights = int(model_.lights.size());
  auto pixels = std::make_unique<Buffer>(context_, "pixels", std::size_t(view.width) * view.height * 16);
  const auto look = [&](Program& p) {
    const scene::Camera& camera = view.camera;
    const bool perspective = camera.kind == scene::Camera::Kind::perspective;
    const double half = perspective ? std::tan(0.5 * camera.vertical_fov) : 0.5 * camera.height;
    p.set("perspective", perspective);
    p.set("camera_position", camera.position);
    p.set("camera_forward", camera.forward);
    p.set("camera_right", Vec3(camera.right * (half * view.width / view.height)));
    p.set("camera_up", Vec3(camera.up * half));
    p.set("width", view.width);
    p.set("height", view.height);
  };
  const std::map<std::string, std::string> square = {{"LOCAL_SIZE_X", std::to_string(tile)},
                                                     {"LOCAL_SIZE_Y", std::to_string(tile)}};
  bind();
  if (distances) distances->bind(3);
  pixels->bind(6);

  if (n == 0) {
    Program& p = program("fogshop/homogeneous.comp", square);
    look(p);
    p.set("has_distances", distances != nullptr);
    p.set("light_count", lights);
    p.set("source_radius", o.source_radius);
    p.dispatch(view.width, view.height);
    timer.stage("airlight");
    return pixels;
  }

  const int columns = (view.width + tile - 1) / tile, rows = (view.height + tile - 1) / tile;
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
  Program& p = program(model_.paper() ? "fogshop/paper.comp" : "fogshop/slices.comp", definitions);
  look(tiles);
  look(p);
  p.set("has_distances", distances != nullptr);
  p.set("source_radius", o.source_radius);
  if (!model_.paper()) {
    p.set("boxes", o.boxes);
    p.set("extrapolate", o.extrapolate);
    p.set("clearest", float((model_.fog.hue > 0).select(model_.fog.hue, 1.0).minCoeff()));
    p.set("map_directions", o.map_directions);
    p.set("map_edges", o.map_edges);
  }
  for (int first = 0; first < rows; first += strip) {
    const int count = std::min(strip, rows - first);
    tiles.set("tile_row", first);
    tiles.set("tile_rows", count);
    tiles.set("tile_columns", columns);
    tiles.dispatch(columns * count);
    timer.stage("tiles");
    p.set("tile_row", first);
    p.dispatch(columns * tile, count * tile);
    timer.stage("airlight");
  }
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
