// The environment behind everything, in shaders: radiance of the scene's environment lights through the medium.
#pragma once
#include <vector>

#include "gpu/environment_lights.h"
#include "gpu/fogshop/fog.h"

namespace airlight::gpu::fogshop {

class Background {
 public:
  // Uploads the maps and coefficients of all environment lights. Throws Unavailable for a map above the device's limit
  // of a storage block.
  Background(Context&, const scene::Scene&, const FogOnDevice&);

  // Other turns, brightness and coefficients; false, and nothing is done: other maps, or lights of another kind.
  bool become(const scene::Scene& scene) { return lights_.become(scene); }

  // Adds e^-T L of every pixel whose ray nothing ends to `surface`, 3 floats each: `distances` [m] by pixel (null: all
  // are infinite), `pixels` as FogOnDevice::airlight left them (null: there is no medium).
  void draw(const FogOnDevice&, const scene::View&, const Buffer* distances, const Buffer* pixels,
            const Buffer& surface);

 private:
  EnvironmentLights lights_;
  std::vector<Program*> programs_;  // one each
};

}  // namespace airlight::gpu::fogshop
