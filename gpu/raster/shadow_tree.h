// All surfaces of a scene as raster/shadow_tree.glsl tests shadow rays against them.
#pragma once
#include "gpu/buffer.h"
#include "gpu/linked_program.h"
#include "scene/scene.h"

namespace airlight::gpu {

class ShadowTree {
 public:
  // About 37 bytes a triangle. Throws Unavailable above the device's limits.
  ShadowTree(Context&, const scene::Scene&);

  // Binds 14, sets its uniforms.
  void bind(LinkedProgram&) const;

 private:
  struct Data;
  static Data data(const scene::Scene&);
  ShadowTree(Context&, const Data&);

  int nodes_, solids_;
  Point3 middle_;
  Buffer tree_;
};

}  // namespace airlight::gpu
