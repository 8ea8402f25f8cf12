// The hit that the device has found in a pixel, as a hit of the CPU.
//
// The device tells the primitive and the distance as a float; here the ray meets that very primitive in double
// precision again, so that points lie on their surface to rounding and shadow rays start where the CPU's own would.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace airlight::gpu::test {

class PixelEnds {
 public:
  // Keeps the scene by reference.
  explicit PixelEnds(const scene::Scene&);

  // `primitive` and `distance` [m] as FirstHits::find leaves them.
  scene::RayEnd at(int primitive, float distance, const Ray&) const;

 private:
  const scene::Scene& scene_;
  std::vector<int> mesh_, first_triangle_;  // surfaces that are meshes
  std::vector<int> solid_;                  // surfaces that are not
  int triangles_ = 0;
};

}  // namespace airlight::gpu::test
