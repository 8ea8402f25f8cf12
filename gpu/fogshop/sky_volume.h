// The grid of methods/fogshop/sky_volume.h on the device: light of the environment inside the Gaussians.
#pragma once
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "methods/fogshop/model.h"

namespace airlight::gpu::fogshop {

class FogOnDevice;

class SkyVolumeOnDevice {
 public:
  // Computes the nodes, 12 bytes each, by as many dispatches as keep each of them short. Requires a Gaussian. Throws
  // Unavailable where the device has no storage block of that size.
  SkyVolumeOnDevice(Context&, FogOnDevice&, const scene::Scene&, const airlight::fogshop::Model&,
                    const scene::Execution&);

  // For a program that includes fogshop/sky_volume.glsl: its uniforms, and the nodes at binding 7.
  void use(Program&) const;

 private:
  airlight::fogshop::SkyGrid grid_;
  Buffer nodes_;
};

}  // namespace airlight::gpu::fogshop
