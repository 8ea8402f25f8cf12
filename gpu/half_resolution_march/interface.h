// Constants and layouts shared by host and shaders of the half-resolution march.
#pragma once
#include <array>
#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::half_resolution_march {

// Storage blocks, AT_... in shaders, beside those of the media and of pixels (ray_marcher/interface.h).
namespace at {
enum Binding { blocks = 7, low = 8, last = 10, blurred = 10 };
}  // namespace at

// The layouts of blocks.glsl.
struct BlockData {
  std::array<float, 2> film;
  float depth, t_end;
  std::array<float, 3> airlight;
  int frame;
  std::array<float, 3> transmittance;
  int step;
  std::array<float, 3> frame_airlight;
  float weighted;
  std::array<float, 3> frame_transmittance;
  int light;
  float distance;
  unsigned points, look_ups, occlusion_rays;
};
static_assert(sizeof(BlockData) == 96);
// Before the blocks.
struct BlocksHead {
  unsigned longest_bits, history_used, history_rejected, history_clamped;
};
struct LowPixelData {
  std::array<float, 3> airlight;
  float depth;
  std::array<float, 3> transmittance;
  float unused;
};

// A program with these bindings and those of the media defined.
Program& program(Context&, const std::string& file, std::map<std::string, std::string> definitions);

}  // namespace airlight::gpu::half_resolution_march
