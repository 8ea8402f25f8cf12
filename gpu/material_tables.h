// A scene's reflectances for shaders (common/reflection.glsl).
#pragma once
#include <array>
#include <vector>

#include "scene/scene.h"

namespace airlight::gpu {

// The layout of common/reflection.glsl.
struct MaterialData {
  std::array<float, 4> diffuse, specular;
  std::array<int, 4> table, places;
};

struct MaterialTables {
  explicit MaterialTables(const scene::Scene&);

  std::vector<MaterialData> materials;  // by surface
  std::vector<float> values;            // of tabulated reflectances, one after the other
};

}  // namespace airlight::gpu
