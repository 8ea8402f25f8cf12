// Radiance at the ends of rays, without the fog in front of them: surfaces in the light of lamps, which comes through
// the fog, and the environment.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "gpu/environment_lights.h"
#include "gpu/material_tables.h"
#include "gpu/raster/first_hits.h"
#include "gpu/wavelet_fog/interface.h"

namespace airlight::gpu::wavelet_fog {

// Does anything end rays: surfaces, or balls of lights; does a lamp light surfaces.
bool something_ends_rays(const scene::Scene&);
bool lamps_light_surfaces(const scene::Scene&);

// The uniforms of lamp.glsl.
void set_lamp(Program&, const scene::Light&);

class SurfaceLight {
 public:
  // Keeps the surfaces by reference; null: there are none. Throws Unavailable where the driver ends loops before a shadow ray
  // has passed all surfaces.
  SurfaceLight(Context&, const scene::Scene&, const FirstHits*);

  // The lights of another scene with equal surfaces. False, and nothing is done: its environments have other maps, or lamps light surfaces in
  // one of the scenes alone.
  bool become(const scene::Scene&);

  // False: no lamp lights a surface, and there is no environment: `lit` is not written.
  bool shines() const { return reflects_ || environments_.count() > 0; }
  // Renders with the lights of `scene`, which is the scene of the constructor or of become(), or one whose lamps moved. `primitives` may be null.
  // `dim` multiplies the light of a lamp in `lit` by the transmittance of the media between lamp and surfaces.
  void render(const scene::Scene&, const scene::View&, const Buffer* primitives, const Buffer& lit,
              const std::function<void(const scene::Light&)>& dim);

 private:
  SurfaceLight(Context&, const scene::Scene&, const FirstHits*, const MaterialTables&);
  void reflect(const scene::Light&, const scene::View&, const Buffer& primitives, const Buffer& lit, bool first);

  const FirstHits* first_hits_;
  bool reflects_;
  double magnitude_ = 0;  // greatest coordinate of a surface [m]
  Buffer materials_, reflectances_;
  EnvironmentLights environments_;
  Program* surfaces_ = nullptr;
  std::vector<Program*> backgrounds_;  // by environment
};

}  // namespace airlight::gpu::wavelet_fog
