// Which boxes surfaces may touch.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::fogshop {

class SurfaceBoxes {
 public:
  explicit SurfaceBoxes(const std::vector<scene::Surface>&);

  Box bounds() const;            // of all surfaces; infinite with a plane
  std::vector<int> all() const;  // every triangle and sphere

  // Whether a surface touches the box, or may: of triangles and spheres their own boxes count. `candidates` are all of
  // them that need be asked; those that do touch it are added to `touching`.
  bool touch(const Box&, const std::vector<int>& candidates, std::vector<int>& touching) const;

 private:
  std::vector<Box> boxes_;
  std::vector<scene::Plane> planes_;
};

}  // namespace airlight::fogshop
