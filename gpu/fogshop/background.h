// The environment behind everything, in shaders: radiance of the scene's environment lights through the medium.
#pragma once
#include <memory>
#include <vector>

#include "gpu/fogshop/passes.h"

namespace airlight::gpu {

class Background {
 public:
  // Uploads the maps and coefficients of all environment lights. Throws Unavailable for a map above the device's limit
  // of a storage block.
  Background(Context&, const scene::Scene&);

  // Adds e^-T L of every pixel whose ray nothing ends to `surface`, 3 floats each: `distances` [m] by pixel (null: all
  // are infinite), `pixels` as FogOnDevice::airlight left them (null: there is no medium).
  void draw(FogOnDevice&, const scene::View&, const Buffer* distances, const Buffer* pixels, const Buffer& surface);

 private:
  struct Light {
    int kind, order, width, height;
    Rgb scale;
    Mat3 to_map;
    std::unique_ptr<Buffer> values;
  };
  Context& context_;
  std::vector<Light> lights_;
};

}  // namespace airlight::gpu
