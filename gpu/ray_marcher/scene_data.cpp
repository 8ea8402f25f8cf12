#include "gpu/ray_marcher/scene_data.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/shapes.h"
#include "scene/base/error.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"

namespace airlight::gpu::ray_marcher {
namespace {

using airlight::ray_marcher::Frame;
using airlight::ray_marcher::Layer;

Float3 float3(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }
Float3 float3(const float v[3]) { return {v[0], v[1], v[2]}; }

// local = m (x + middle) + b, for x relative to the middle.
std::array<Float4, 3> frame_data(const Frame& frame, const Point3& middle) {
  const Point3 shift = frame.point(middle);
  std::array<Float4, 3> rows;
  for (int i = 0; i < 3; ++i)
    rows[i] = {float(frame.m[3 * i]), float(frame.m[3 * i + 1]), float(frame.m[3 * i + 2]), float(shift[i])};
  return rows;
}

std::size_t samples(const airlight::ray_marcher::GridField& grid) {
  return std::size_t(grid.size[0]) * grid.size[1] * grid.size[2];
}

// Local coordinates of a field without a kernel on the CPU: metres from the middle of its box. Sides of the box may be infinite.
Point3 middle_of(const Box& box) {
  Point3 middle;
  for (int a = 0; a < 3; ++a) {
    const bool from = std::isfinite(box.lo[a]), to = std::isfinite(box.hi[a]);
    middle[a] = from && to ? 0.5 * (box.lo[a] + box.hi[a]) : from ? box.lo[a] : to ? box.hi[a] : 0;
  }
  return middle;
}
float finite(double metres) { return float(std::clamp(metres, -1e18, 1e18)); }

// Two rows from local x and z to cells, from the first with coefficients on; knots; coefficients with a border of `degree` zeros.
void add_map(const scene::Fogmap& fog, const Point3& middle, std::vector<float>& data) {
  const double x = middle[0] - fog.x0, z = middle[2] - fog.z0;
  const scene::IndexRange& range = fog.map.range();
  const int n = fog.map.degree();
  for (const double value : {fog.cos_turn / fog.cell, -fog.sin_turn / fog.cell,
                             (x * fog.cos_turn - z * fog.sin_turn) / fog.cell - range.lo[0], fog.sin_turn / fog.cell,
                             fog.cos_turn / fog.cell, (x * fog.sin_turn + z * fog.cos_turn) / fog.cell - range.lo[1]})
    data.push_back(float(value));
  scene::match(
      fog.profile, [](const scene::SameAtAllHeights&) {},
      [&](const scene::Layers& layers) {
        for (std::size_t i = 0; i < layers.heights.size(); ++i) {
          data.push_back(float(layers.heights[i] - middle[1]));
          data.push_back(float(layers.factors[i]));
        }
      },
      [&](const scene::ExponentialFall& fall) {
        data.push_back(float(fall.base - middle[1]));
        data.push_back(float(fall.scale_height));
      });
  for (int j = -n; j < range.size[1] + n; ++j)
    for (int i = -n; i < range.size[0] + n; ++i)
      data.push_back(float(fog.map.coefficient(range.lo[0] + i, range.lo[1] + j)));
}
int knots_of(const scene::HeightProfile& profile) { return int(height_breaks(profile).size()); }

// Factors to [-1, 1]; coefficients of polynomials that are 1 at the end.
void add_series(const scene::LegendreBox& box, std::vector<float>& data) {
  for (int a = 0; a < 3; ++a) data.push_back(float(2 / box.box().size()[a]));
  const scene::TensorShape& n = box.shape();
  for (int i = 0, at = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k, ++at)
        data.push_back(float(box.coefficients()[at] * std::sqrt((i + 0.5) * (j + 0.5) * (k + 0.5))));
}

}  // namespace

Point3 middle_of(const Layers& layers, const Point3& otherwise) {
  Box box;
  for (const Layer& layer : layers) {
    const Box own = bounding_box(*layer.medium), varied = layer.varies ? support(layer.medium->field) : own;
    for (const Box& b : {own, varied})
      if (!b.empty() && b.size().allFinite()) box = unite(box, b);
    if (layer.gaussians) {
      const auto& lo = layer.gaussians->lo;
      const auto& hi = layer.gaussians->hi;
      const Point3 center =
          -Vec3(layer.gaussians->frame.b[0], layer.gaussians->frame.b[1], layer.gaussians->frame.b[2]);
      box = unite(box, {center + Vec3(lo[0], lo[1], lo[2]), center + Vec3(hi[0], hi[1], hi[2])});
    }
  }
  return box.empty() ? otherwise : box.center();
}

std::vector<LayerData> layer_data(const Layers& layers, const Point3& middle, bool textures) {
  std::vector<LayerData> data;
  std::size_t gaussians = 0, values = 0, bricks = 0, grids = 0, series = 0;
  for (const Layer& layer : layers)
    if (layer.gaussians) series += layer.gaussians->count * sizeof(GaussianData) / sizeof(float);
  for (const Layer& layer : layers) {
    LayerData d{};
    d.sigma_t = float3(Vec3(layer.medium->sigma_t));
    d.albedo = float3(Vec3(layer.medium->albedo));
    d.constant = float(layer.constant);
    d.most_varied = float(layer.most_varied);
    d.thickest = float(layer.thickest);
    d.half_size = float3(layer.shape.half);
    d.shape = int(layer.shape.kind);
    d.shape_frame = frame_data(layer.shape_frame, middle);
    const airlight::ray_marcher::PhaseShape phase = airlight::ray_marcher::phase_shape(layer.medium->phase);
    d.phase = int(phase.kind);
    d.g = phase.g;
    const auto set_grid = [&] {
      const airlight::ray_marcher::GridField& grid = *layer.grid;
      d.field = 1;
      d.field_frame = frame_data(grid.frame, middle);
      d.lo = float3(grid.lo), d.hi = float3(grid.hi);
      d.first = int(textures ? grids : values), d.first_brick = int(bricks);
      d.size = {grid.size[0], grid.size[1], grid.size[2]};
      d.bricks = {grid.bricks[0], grid.bricks[1], grid.bricks[2]};
      values += samples(grid), bricks += grid.samples->free_distance.size(), ++grids;
    };
    const auto set_series = [&](int field, const auto& add) {
      const Box box = bounding_box(layer.varied);
      const Point3 own = middle_of(box);
      d.field = field;
      d.field_frame = frame_data({{1, 0, 0, 0, 1, 0, 0, 0, 1}, {-own[0], -own[1], -own[2]}}, middle);
      for (std::size_t a = 0; a < 3; ++a) {
        d.lo[a] = finite(box.lo[Eigen::Index(a)] - own[Eigen::Index(a)]);
        d.hi[a] = finite(box.hi[Eigen::Index(a)] - own[Eigen::Index(a)]);
      }
      d.first = int(series);
      std::vector<float> list;
      add(own, list);
      series += list.size();
    };
    scene::match(
        layer.medium->field, [](const scene::Homogeneous&) {},
        [&](const scene::GaussianSum&) {
          if (!layer.varies) return;
          const airlight::ray_marcher::GaussianField& field = *layer.gaussians;
          d.field = 2;
          d.field_frame = frame_data(field.frame, middle);
          d.lo = float3(field.lo), d.hi = float3(field.hi);
          d.first = int(gaussians), d.count = int(field.count);
          d.negative = field.any_negative;
          gaussians += field.count;
        },
        [&](const scene::GridPointer&) { set_grid(); },
        [&](const scene::FogmapPointer& fog) {
          set_series(3, [&](const Point3& own, std::vector<float>& list) { add_map(*fog, own, list); });
          const int n = fog->map.degree();
          const scene::IndexRange& range = fog->map.range();
          d.size = {range.size[0] + 2 * n, range.size[1] + 2 * n, knots_of(fog->profile)};
          d.bricks = {n, int(fog->profile.index()), 0};
        },
        [&](const scene::LegendrePointer& box) {
          set_series(4, [&](const Point3&, std::vector<float>& list) { add_series(*box, list); });
          d.size = {box->shape()[0], box->shape()[1], box->shape()[2]};
        },
        [&](const scene::FittedPointer&) { set_grid(); });
    data.push_back(d);
  }
  if (data.empty()) data.emplace_back();  // the block has one at least
  return data;
}

std::vector<GaussianData> gaussian_data(const Layers& layers) {
  std::vector<GaussianData> data;
  for (const Layer& layer : layers) {
    if (!layer.gaussians) continue;
    const airlight::ray_marcher::GaussianField& f = *layer.gaussians;
    for (std::size_t i = 0; i < f.count; ++i) {
      const float reach = f.reach[i] * f.inverse_width[i];
      data.push_back({{f.x[i], f.y[i], f.z[i]}, f.inverse_width[i], f.amplitude[i], reach * reach, {0, 0}});
    }
  }
  return data;
}

std::vector<float> series_data(const Layers& layers) {
  std::vector<float> list;
  for (const Layer& layer : layers) {
    if (const auto* fog = std::get_if<scene::FogmapPointer>(&layer.medium->field))
      add_map(**fog, middle_of(bounding_box(layer.varied)), list);
    if (const auto* box = std::get_if<scene::LegendrePointer>(&layer.medium->field)) add_series(**box, list);
  }
  if (list.empty()) return list;
  const std::vector<GaussianData> gaussians = gaussian_data(layers);
  const auto* first = reinterpret_cast<const float*>(gaussians.data());
  list.insert(list.begin(), first, first + gaussians.size() * sizeof(GaussianData) / sizeof(float));
  return list;
}

std::vector<float> brick_data(const Layers& layers) {
  std::vector<float> data;
  for (const Layer& layer : layers)
    if (layer.grid)
      data.insert(data.end(), layer.grid->samples->free_distance.begin(), layer.grid->samples->free_distance.end());
  return data;
}

void grid_slice(const airlight::ray_marcher::GridField& grid, int z, std::vector<float>& values) {
  // The CPU keeps each sample with its neighbour along z; here only the samples.
  values.resize(std::size_t(grid.size[0]) * grid.size[1]);
  const float* pair = grid.samples->pairs.data() + 2 * values.size() * std::size_t(z);
  for (float& value : values) value = *pair, pair += 2;
}

std::vector<float> grid_data(const Layers& layers) {
  std::vector<float> data, slice;
  for (const Layer& layer : layers)
    for (int z = 0; layer.grid && z < layer.grid->size[2]; ++z) {
      grid_slice(*layer.grid, z, slice);
      data.insert(data.end(), slice.begin(), slice.end());
    }
  return data;
}

std::vector<SolidData> solid_data(const scene::Scene& scene, const Point3& middle) {
  std::vector<SolidData> data;
  for (const scene::Surface& surface : scene.surfaces) {
    if (const auto* sphere = std::get_if<scene::Sphere>(&surface.shape))
      data.push_back({float3(Vec3(sphere->center - middle)), float(sphere->radius), {0, 0, 0}, 0});
    if (const auto* plane = std::get_if<scene::Plane>(&surface.shape)) {
      // The point of the plane nearest to the middle: the one given may be far away.
      const Vec3 near = plane->normal * plane->normal.dot(plane->point - middle);
      data.push_back({float3(near), 0, float3(plane->normal), 0});
    }
  }
  return data;
}

std::vector<scene::Light> balls_first(std::vector<scene::Light> lights) {
  std::stable_partition(lights.begin(), lights.end(), [](const scene::Light& light) { return bool(ball(light)); });
  return lights;
}

std::vector<LightData> light_data(const std::vector<scene::Light>& lights, const Point3& middle) {
  std::vector<LightData> data;
  for (const scene::Light& light : lights) {
    const airlight::ray_marcher::LightShape shape = airlight::ray_marcher::light_shape(light);
    const Vec3 position(shape.position[0], shape.position[1], shape.position[2]),
        axis(shape.axis[0], shape.axis[1], shape.axis[2]);
    data.push_back({float3(Vec3(position - middle)), int(shape.kind), float3(axis), float(shape.cos_inner),
                    float3(Vec3(airlight::ray_marcher::light_colour(light))), float(shape.cos_outer)});
  }
  return data;
}

}  // namespace airlight::gpu::ray_marcher
