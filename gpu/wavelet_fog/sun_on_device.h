// Light of suns that one medium scatters once, with nothing in their way: the twin of methods/wavelet_fog/sun_scattering.h.
#pragma once
#include "gpu/wavelet_fog/fog_on_device.h"

namespace airlight::gpu::fogmaps {

class SunOnDevice {
 public:
  // The fog outlives this.
  SunOnDevice(Context&, FogOnDevice&, const wavelet_fog::Options&);

  // Adds up all suns of the scene to `airlight`, 3 floats a pixel. Maps of columns, one after the other in one buffer, are made for
  // each sun in every frame.
  void render(const scene::Scene&, const scene::View&, FrameBuffers&, const Buffer* distances, const Buffer& airlight,
              const Buffer& counters, bool counts);

 private:
  void fill_map(const Vec3& to_sun, FrameBuffers&, const Buffer& depths);

  Context& context_;
  FogOnDevice& fog_;
  wavelet_fog::Options options_;
  Program *steps_, *sums_, *scatter_;
};

// Directional lights that shine.
std::vector<const scene::DirectionalLight*> suns_of(const scene::Scene&);

}  // namespace airlight::gpu::fogmaps
