// Layers and lights as the shaders of the ray marcher read them: std140 and std430, single precision.
//
// World coordinates on the device are relative to a middle of the scene, so that a scene far from the origin keeps its
// digits; whatever is subtracted from is in double.
#pragma once
#include <array>
#include <vector>

#include "reference/ray_marcher/plan.h"

namespace airlight::gpu::ray_marcher {

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

struct LayerData {
  Float3 sigma_t;
  float constant;
  Float3 albedo;
  int field;  // 0 none, 1 grid, 2 Gaussians, 3 fogmap, 4 Legendre box
  Float3 half_size;
  int shape;
  std::array<Float4, 3> shape_frame, field_frame;
  Float3 lo;
  int first;
  Float3 hi;
  int count;
  std::array<int, 3> size;
  int first_brick;
  std::array<int, 3> bricks;
  int phase;
  float g;
  int negative;
  float most_varied, thickest;
};
static_assert(sizeof(LayerData) == 224);
// Layers fill a uniform block. OpenGL promises 16 KiB for one. Marches with a list of parts take the CPU's 32.
inline constexpr std::size_t most_layers = 16384 / sizeof(LayerData);

struct GaussianData {
  Float3 center;
  float inverse_width, amplitude, limit, unused[2];
};
struct LightData {
  Float3 position;
  int kind;
  Float3 axis;
  float cos_inner;
  Float3 colour;
  float cos_outer;
};

struct SolidData {
  Float3 place;  // of a sphere's centre, or of a point of a plane
  float radius;  // 0: a plane
  Float3 normal;
  float unused;
};

using Layers = std::vector<airlight::ray_marcher::Layer>;

// Centre of the finite regions and supports; `otherwise` if there are none.
Point3 middle_of(const Layers&, const Point3& otherwise);

// With `textures` a grid's `first` is the number of its texture, else the place of its values.
std::vector<LayerData> layer_data(const Layers&, const Point3& middle, bool textures);
// Values of all layers, one list after the other.
std::vector<GaussianData> gaussian_data(const Layers&);
// The Gaussians of all layers and, behind them, what layer.glsl reads of fogmaps and Legendre boxes. Empty without the latter.
std::vector<float> series_data(const Layers&);
std::vector<float> brick_data(const Layers&);
std::vector<float> grid_data(const Layers&);
// Slice z of one grid, x fastest: padded samples.
void grid_slice(const airlight::ray_marcher::GridField&, int z, std::vector<float>& values);
std::vector<SolidData> solid_data(const scene::Scene&, const Point3& middle);

// Lights in the order of the device: point and spot lights first, for only they may have marches of their own.
std::vector<scene::Light> balls_first(std::vector<scene::Light>);
std::vector<LightData> light_data(const std::vector<scene::Light>&, const Point3& middle);

}  // namespace airlight::gpu::ray_marcher
