// Objects as sets of spheres, which cast the shadows of the publication: Zhou et al. 2008, section 7 (Figure 11), after Ren et al. 2006.
#pragma once
#include <vector>

#include "scene/geometry/surface.h"

namespace airlight::compensated_ray_marching {

// At most `count` spheres within a closed mesh: greedily those that cover most of its inside that no sphere before covers, on a grid of
// 24 cells along the longest side, by which they may stand out. Fewer where another would add less than a hundredth of the inside; none
// where a mesh encloses nothing.
std::vector<scene::Sphere> sphere_set(const scene::TriangleMesh&, int count);

// All that cast shadows: spheres of a scene, and those of its meshes. Planes cast none.
struct Caster {
  scene::Sphere sphere;
  int surface;  // its number
};
std::vector<Caster> casters_of(const std::vector<scene::Surface>&, int of_a_mesh);

}  // namespace airlight::compensated_ray_marching
