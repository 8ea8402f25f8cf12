// Fogmaps by B-spline wavelets in compute shaders: the method of methods/wavelet_fog, the same settings, layers and pictures, in
// single precision. Giroud and Biri 2010.
//
// Coarse grids, what is known of blocks and tables of integrals are made on the device; Prepared::next takes other fogmaps of the
// same size besides other lights: their coefficients go up, nothing comes back.
#pragma once
#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu::wavelet_fog {

class WaveletFog final : public scene::Renderer {
 public:
  std::string name() const override { return "wavelet_fog_gpu"; }
  std::string about() const override;
  std::string device() const override { return Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::gpu::wavelet_fog
