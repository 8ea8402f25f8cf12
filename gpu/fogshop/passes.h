// The dispatches of one fog: what lies on the device, and the shaders that read it.
#pragma once
#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/fogshop/sky_volume.h"
#include "gpu/program.h"
#include "gpu/raster/hit_image.h"
#include "gpu/timer.h"
#include "methods/fogshop/environment_lighting.h"
#include "methods/fogshop/low_resolution.h"
#include "methods/fogshop/model.h"
#include "scene/renderer.h"

namespace airlight::gpu {

inline constexpr int most_slices = 128, most_lights = 16;  // arrays of the shaders

// llvmpipe ends all loops of an invocation after 65535 iterations in all and says nothing: the picture would be wrong.
// Throws Unavailable on a software renderer instead.
inline constexpr double most_iterations = 65000;
void check_iterations(const Context&, double iterations, const char* what);

class FogOnDevice {
 public:
  FogOnDevice(Context&, const fogshop::Model&);

  void fill_light_maps();                     // variant S
  void fill_light_depths();                   // variant paper: T(s,b_i)
  void fill_view_depths(const Point3& view);  // variant paper: T(v,b_i), T(s,v)

  // From now on airlight() adds light of the environment, by Eq. 28 or by a grid and slices.
  void upload_environment(const fogshop::EnvironmentLighting&);
  void fill_sky_volume(const scene::Scene&);

  void upload_f_table(const fogshop::FTable&);  // from now on Eq. 17 takes F from it

  // 4 floats per pixel: airlight [W/m^2/sr], T(v,p) [-] where the hue is 1. `distances` holds d_vp of every pixel [m];
  // null: every ray is infinite (or reaches to the environment's distance). Tiles first list the Gaussians that their
  // rays may meet; images are done in strips whose lists fit into one storage block.
  std::unique_ptr<Buffer> airlight(const scene::View&, const Buffer* distances, StageTimer&);

  // The same at the settings' lower resolution, brought back to the film's on the device: `low_distances` holds d_vp of
  // the low pixels [m]; both are null where every ray is infinite.
  std::unique_ptr<Buffer> low_resolution_airlight(const scene::View&, const Buffer* distances,
                                                  const Buffer* low_distances, StageTimer&);

  // The film's layers, 3 floats per pixel: `pixels` of airlight() (null: there is no medium) and the surfaces' light
  // through the medium (null: there is none).
  void compose(const Buffer* pixels, const Buffer* surface, const Buffer& airlight, const Buffer& transmittance,
               const Buffer& mean);

  // A program that includes fog.glsl, with the medium's uniforms set; bind() gives it the Gaussians (0), lights (4),
  // their maps (5) and depths (8).
  Program& program(const char* file, std::map<std::string, std::string> definitions);
  void bind() const;

 private:
  float open_distance() const;  // [m] of rays that nothing ends
  void compute(const scene::View&, int step, bool has_distances, bool only_edges, StageTimer&);
  void add_environment(const scene::View&, bool has_distances, StageTimer&);
  void fill_depths(const std::vector<struct Segment>&, std::size_t first);

  Context& context_;
  const fogshop::Model& model_;
  Buffer gaussians_, lights_, maps_, depths_, colours_, permutation_;
  int bands_ = 0, band_depths_ = 0;             // of the environment; 0: none
  std::unique_ptr<Buffer> light_, band_table_;  // its harmonics, those of the PSF
  std::unique_ptr<SkyVolumeOnDevice> sky_;      // null: none
  std::unique_ptr<Buffer> f_table_;             // the same
  int f_table_size_ = 0;
};

}  // namespace airlight::gpu
