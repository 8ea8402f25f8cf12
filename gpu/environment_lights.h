// The environment lights of a scene in storage buffers, as common/environment.glsl reads them, one at a time.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/linked_program.h"
#include "scene/scene.h"

namespace airlight::gpu {

class EnvironmentLights {
 public:
  // Uploads maps and coefficients. Throws Unavailable for a map above the device's limit of a storage block.
  EnvironmentLights(Context&, const scene::Scene&);

  // Other turns, brightness and coefficients; false, and nothing is done: other maps, or lights of another kind.
  bool become(const scene::Scene&);

  // The texels of one of the lights' maps: rgb.
  const Buffer& texels(const std::shared_ptr<const scene::EnvironmentMap>&) const;
  int count() const { return int(lights_.size()); }
  // KIND and SH_ORDER, which a program that includes environment.glsl needs for one of them.
  std::map<std::string, std::string> definitions(int light) const;
  // Binds 9, sets the uniforms.
  void bind(int light, LinkedProgram&) const;

 private:
  struct Light {
    int kind, order, width, height;
    Rgb scale;
    Mat3 to_map;
    std::unique_ptr<Buffer> values;
    std::shared_ptr<const scene::EnvironmentMap> from;
  };
  std::vector<Light> lights_;
};

}  // namespace airlight::gpu
