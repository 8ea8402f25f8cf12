// A Gaussian as shaders have it: Gaussian of smoke_density.glsl and smoke_volume.comp.
#pragma once
#include "scene/math/types.h"

namespace airlight::gpu::compensated_ray_marching {

struct GaussianData {
  float center[3], width, amplitude, unused[3] = {0, 0, 0};
};
inline GaussianData gaussian_data(const Vec3& center, double width, double amplitude) {
  return {{float(center[0]), float(center[1]), float(center[2])}, float(width), float(amplitude)};
}

}  // namespace airlight::gpu::compensated_ray_marching
