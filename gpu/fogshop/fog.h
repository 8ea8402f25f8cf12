// One fog on the device: what lies there, and the shaders that read it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/fogshop/sky_volume.h"
#include "gpu/frame.h"
#include "gpu/program.h"
#include "gpu/raster/first_hits.h"
#include "methods/fogshop/environment_lighting.h"
#include "methods/fogshop/low_resolution.h"
#include "methods/fogshop/model.h"
#include "methods/fogshop/next_frame.h"
#include "methods/fogshop/stages.h"
#include "scene/renderer.h"

namespace airlight::gpu::fogshop {

using Definitions = std::map<std::string, std::string>;

// llvmpipe ends all loops of an invocation after 65535 iterations in all and says nothing: the picture would be wrong.
// Throws Unavailable on a software renderer instead.
inline constexpr double most_iterations = 65000;
inline constexpr int depth_group = 64;  // invocations that sum one depth
void check_iterations(const Context&, double iterations, const char* what);

class FogOnDevice {
 public:
  // Uploads the medium and compiles what a frame of these needs runs. The model must live on. Throws Unavailable where
  // the device has no room, or where a software renderer would end loops.
  FogOnDevice(Context&, const airlight::fogshop::Model&, const airlight::fogshop::Needs&);

  // The model has become that of the next frame, which is_like() the one before: uploads what is not `unchanged`.
  void become(const airlight::fogshop::Needs&, const airlight::fogshop::Unchanged&);

  // Each fills what lights lack, and returns how many lights that were.
  int fill_light_maps();                      // variant S
  int fill_light_depths();                    // variant paper: T(s,b_i)
  void fill_view_depths(const Point3& view);  // variant paper, every frame: T(v,b_i), T(s,v)

  // Light of the environment that airlight() adds, by Eq. 28 or by a grid and slices: before the first frame, and where it has changed.
  void upload_environment(const airlight::fogshop::EnvironmentLighting&);
  void fill_sky_volume(const scene::Scene&, const scene::Execution&);

  // 4 floats per pixel: airlight [W/m^2/sr], T(v,p) [-] where `extinction_ratio` is 1. `distances` holds d_vp of every pixel [m];
  // null: every ray is infinite (or reaches to the environment's distance). Tiles first list the Gaussians that their
  // rays may meet; images are done in strips.
  const Buffer& airlight(const scene::View&, const Buffer* distances, Frame&);

  // Airlight at the settings' lower resolution, upsampled to the film's. `low_distances` holds d_vp of the low pixels
  // [m]; both buffers are null where every ray is infinite.
  const Buffer& low_resolution_airlight(const scene::View&, const Buffer* distances, const Buffer* low_distances,
                                        Frame&);

  // The film's layers, 3 floats per pixel, in the frame's buffers "airlight", "transmittance", "mean", and into its
  // download: `pixels` of airlight() (null: there is no medium) and the surfaces' light through it (null: there is none). What
  // backdrops show (`seen` of gpu/raster/backdrops.h, null: there are none) takes the place of surfaces.
  void compose(const scene::View&, const Buffer* pixels, const Buffer* surface, const Buffer* seen, Frame&);

  // A program that includes fog.glsl, to be found once and kept.
  Program& program(const char* file, Definitions definitions) const;
  // The medium's uniforms, for others use a program with other values in between; the Gaussians (0), lights (4), their
  // maps (5) and depths (8).
  void use(Program&) const;
  void bind() const;

 private:
  struct Programs {
    Program *squares = nullptr, *tiles = nullptr, *homogeneous = nullptr, *paper = nullptr, *view_depths = nullptr,
            *upsample = nullptr;
    Program *stretch = nullptr, *shares = nullptr, *edges = nullptr, *slice_depths = nullptr, *slice_light = nullptr;
    Program *even_depths = nullptr, *sky_light = nullptr, *environment = nullptr, *composition = nullptr;
  };
  // Which pixels are computed: one of `step` squared, or those of the film that are edges.
  struct Grid {
    const scene::View& view;
    int step;
    bool has_distances, only_edges;
    int width() const { return (view.width + step - 1) / step; }
    int height() const { return (view.height + step - 1) / step; }
  };
  struct Strip;

  std::vector<float> tables();
  void place_maps(bool keeps);
  bool sliced() const { return !model_.paper() && model_.scattered_lights() > 0 && model_.gaussians.count > 0; }
  float open_distance() const;  // [m] of rays that nothing ends
  void make_programs();
  void fill_depths(Program&, const Point3& from, std::size_t first, bool lights_too);
  void set_grid(Program&, const Grid&) const;
  void set_noise(Program&) const;
  void upsample(const airlight::fogshop::LowResolution&, bool find_edges);
  void compute(const Grid&, Frame&);
  void compute_strip(const Grid&, const Strip&, Frame&);
  void add_environment(const scene::View&, bool has_distances, Frame&);

  Context& context_;
  const airlight::fogshop::Model& model_;
  airlight::fogshop::Needs needs_;
  struct {
    int colours = 0, permutation = 0, f = 0, f_size = 0;  // f_size 0: there is no table of F
  } table_places_;
  std::unique_ptr<Buffer> gaussians_, lights_, maps_, depths_, tables_;
  std::vector<char> lights_uploaded_;
  std::vector<int> map_of_light_;                     // the place of its map in maps_
  std::vector<std::optional<Point3>> map_is_from_;    // by place: where the light stands; nothing: not made yet
  std::vector<std::optional<Point3>> depth_is_from_;  // by light, of depths_
  int bands_ = 0, band_depths_ = 0;                   // of the environment; 0: none
  std::unique_ptr<Buffer> light_, band_table_;        // its harmonics, those of the PSF
  std::unique_ptr<SkyVolumeOnDevice> sky_;            // null: none
  Programs programs_;
};

// Do fogs of these models run the same programs, so that a FogOnDevice can become the other? Both have the same options.
bool is_like(const airlight::fogshop::Model&, const airlight::fogshop::Needs&, const airlight::fogshop::Model&,
             const airlight::fogshop::Needs&);

}  // namespace airlight::gpu::fogshop
