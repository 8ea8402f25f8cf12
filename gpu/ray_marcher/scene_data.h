// Layers and lights as the shaders of the ray marcher read them: std430, single precision.
//
// World coordinates on the device are relative to a middle of the scene, so that a scene far from the origin keeps its
// digits; whatever is subtracted from is in double.
#pragma once
#include <array>
#include <vector>

#include "reference/ray_marcher/plan.h"

namespace airlight::gpu {

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

struct LayerData {
  Float3 sigma_t;
  float constant;
  Float3 albedo;
  int field;  // 0 none, 1 grid, 2 Gaussians
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
  int unused[2];
};
static_assert(sizeof(LayerData) == 224);

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

// Values of all layers, one list after the other.
struct FieldData {
  std::vector<GaussianData> gaussians;
  std::vector<float> grids, bricks;
};

// Centre of the finite regions and supports; of the camera if there are none.
Point3 middle_of(const ray_marcher::Plan&);

std::vector<LayerData> layer_data(const ray_marcher::Plan&, const Point3& middle);
FieldData field_data(const ray_marcher::Plan&);
std::vector<LightData> light_data(const ray_marcher::Plan&, const Point3& middle);

}  // namespace airlight::gpu
