// The environment behind everything, in shaders: radiance of the scene's environment lights through the medium.
#pragma once
#include <memory>
#include <vector>

#include "gpu/fogshop/fog_on_device.h"

namespace airlight::gpu::fog {

class Background {
 public:
  // Uploads the maps and coefficients of all environment lights. Throws Unavailable for a map above the device's limit
  // of a storage block.
  Background(Context&, const scene::Scene&, const FogOnDevice&);

  // Adds e^-T L of every pixel whose ray nothing ends to `surface`, 3 floats each: `distances` [m] by pixel (null: all
  // are infinite), `pixels` as FogOnDevice::airlight left them (null: there is no medium).
  void draw(const FogOnDevice&, const scene::View&, const Buffer* distances, const Buffer* pixels,
            const Buffer& surface);

 private:
  struct Light {
    int kind, order, width, height;
    Rgb scale;
    Mat3 to_map;
    std::unique_ptr<Buffer> values;
    Program* program;
  };
  Context& context_;
  std::vector<Light> lights_;
};

}  // namespace airlight::gpu::fog
