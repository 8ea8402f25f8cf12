// The dispatches of one fog: what lies on the device, and the shaders that read it.
#pragma once
#include <array>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/timer.h"
#include "methods/fogshop/low_resolution.h"
#include "scene/renderer.h"

namespace airlight::gpu {

inline constexpr int most_slices = 128, most_lights = 16;  // arrays of the shaders
inline constexpr float far_away = 1e37f;                   // [m], as fog.glsl: an infinite ray

struct PixelAirlight {
  std::array<float, 3> airlight;  // [W/m^2/sr]
  float depth;                    // T(v, p) [-], hue 1
};

class FogOnDevice {
 public:
  FogOnDevice(Context&, const fogshop::Model&);

  void fill_light_maps();                     // variant S
  void fill_light_depths();                   // variant paper: T(s,b_i)
  void fill_view_depths(const Point3& view);  // variant paper: T(v,b_i), T(s,v)

  // `distance` is d_vp of every pixel [m], empty where every ray is infinite. Tiles first list the Gaussians that their
  // rays may meet; images are done in strips whose lists fit into one storage block.
  std::vector<PixelAirlight> airlight(const scene::View&, const std::vector<float>& distance, StageTimer&);

  // The same at the settings' lower resolution, brought back to the film's on the device: `low_distance` is d_vp of the
  // low pixels [m]; both are empty where every ray is infinite.
  std::vector<PixelAirlight> low_resolution_airlight(const scene::View&, const std::vector<float>& distance,
                                                     const std::vector<float>& low_distance, StageTimer&);

 private:
  Program& program(const char* file, std::map<std::string, std::string> definitions);
  void bind() const;
  void compute(const scene::View&, int step, bool has_distances, bool only_edges, StageTimer&);
  void fill_depths(const std::vector<struct Segment>&, std::size_t first);

  Context& context_;
  const fogshop::Model& model_;
  Buffer gaussians_, lights_, maps_, depths_, colours_, permutation_;
};

}  // namespace airlight::gpu
