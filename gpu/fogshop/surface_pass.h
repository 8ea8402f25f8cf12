// Surfaces in shaders: direct light with shadows, scattered light, light of the environment
// (methods/fogshop/surface_pass.h), and the environment behind everything.
#pragma once
#include <memory>

#include "gpu/fogshop/fog.h"
#include "gpu/fogshop/surface_tables.h"
#include "gpu/raster/first_hits.h"

namespace airlight::gpu::fogshop {

class SurfaceShading {
 public:
  // Uploads materials, light positions and the tables of `lighting`. Both it and the model must live on, and may become those of the next
  // frame.
  SurfaceShading(Context&, const scene::Scene&, const airlight::fogshop::Model&,
                 const airlight::fogshop::SurfaceLighting& lighting, const FogOnDevice&);

  // The model and the lighting have become those of the next frame, which runs the same programs of fogs (is_like) and has the same surfaces:
  // uploads what has changed, and lists Gaussians anew where they or lights have moved. False if there was nothing to do.
  bool become(const scene::Scene&, const FogOnDevice&, const airlight::fogshop::Unchanged&);

  // e^-T L_p of every pixel, 3 floats each: `pixels` as FogOnDevice::airlight left them (null: there is no medium),
  // `primitives` as the first hits did. The scattered part into `scattered` too, if it is there.
  void shade(const FogOnDevice&, const FirstHits&, const scene::View&, const Buffer& primitives, const Buffer* pixels,
             const Buffer& surface, const Buffer* scattered);

 private:
  void upload_tables(const scene::Scene&, const FogOnDevice&);
  void list_gaussians(const FogOnDevice&);

  Context& context_;
  const airlight::fogshop::Model& model_;
  const airlight::fogshop::SurfaceLighting& lighting_;
  double magnitude_;                             // the largest coordinate [m]
  airlight::fogshop::SurfaceLighting uploaded_;  // whose tables these are
  std::map<std::string, int> uniforms_;          // SurfaceTables::uniforms
  double iterations_ = 0, light_iterations_ = 0;
  std::vector<double> lights_at_;
  std::unique_ptr<Buffer> materials_, light_places_, tables_, transfer_;

  std::unique_ptr<Buffer> numbers_, lists_;  // Gaussians by cells of directions from each light
  int cells_ = 0;                            // to a side
  bool casts_shadows_ = false;               // some surface may shadow another one
  Program* program_;
};

}  // namespace airlight::gpu::fogshop
