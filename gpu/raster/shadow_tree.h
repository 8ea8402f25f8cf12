// All triangles of a scene as raster/tree.glsl walks them.
#pragma once
#include "gpu/buffer.h"
#include "gpu/linked_program.h"
#include "scene/scene.h"

namespace airlight::gpu {

class ShadowTree {
 public:
  // About 95 bytes a triangle. Throws Unavailable above the device's limits.
  ShadowTree(Context&, const scene::Scene&);

  // Binds 14, sets its uniforms.
  void bind(LinkedProgram&) const;

  const Point3& middle() const { return middle_; }  // [m]
  int nodes() const { return nodes_; }
  int solids() const { return solids_; }  // of the scene: spheres and planes, which are not in the tree

 private:
  struct Data;
  static Data data(const scene::Scene&);
  ShadowTree(Context&, const Data&);

  int nodes_, solids_;
  Point3 middle_;
  double reach_;
  Buffer tree_;
};

}  // namespace airlight::gpu
