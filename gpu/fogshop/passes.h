// The dispatches of one fog: what lies on the device, and the shaders that read it.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/raster/hit_image.h"
#include "gpu/timer.h"
#include "methods/fogshop/environment_lighting.h"
#include "methods/fogshop/low_resolution.h"
#include "methods/fogshop/model.h"
#include "scene/renderer.h"

namespace airlight::gpu {

inline constexpr int most_slices = 128, most_lights = 16;  // arrays of the shaders

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

  void upload_environment(const fogshop::EnvironmentLighting&);  // from now on airlight() adds Eq. 28

  // `distance` is d_vp of every pixel [m], empty where every ray is infinite. Tiles first list the Gaussians that their
  // rays may meet; images are done in strips whose lists fit into one storage block. `open` is 1 for pixels whose ray
  // nothing ends, empty where that is all of them; read if there is an environment.
  std::vector<PixelAirlight> airlight(const scene::View&, const std::vector<float>& distance,
                                      const std::vector<unsigned>& open, StageTimer&);

  // The same at the settings' lower resolution, brought back to the film's on the device: `low_distance` is d_vp of the
  // low pixels [m]; both are empty where every ray is infinite.
  std::vector<PixelAirlight> low_resolution_airlight(const scene::View&, const std::vector<float>& distance,
                                                     const std::vector<float>& low_distance,
                                                     const std::vector<unsigned>& open, StageTimer&);

 private:
  Program& program(const char* file, std::map<std::string, std::string> definitions);
  void bind() const;
  void compute(const scene::View&, int step, bool has_distances, bool only_edges, StageTimer&);
  void add_environment(const scene::View&, const std::vector<unsigned>& open, StageTimer&);
  void fill_depths(const std::vector<struct Segment>&, std::size_t first);

  Context& context_;
  const fogshop::Model& model_;
  Buffer gaussians_, lights_, maps_, depths_, colours_, permutation_;
  int bands_ = 0, band_depths_ = 0;             // of the environment; 0: none
  std::unique_ptr<Buffer> light_, band_table_;  // its harmonics, those of the PSF
};

}  // namespace airlight::gpu
