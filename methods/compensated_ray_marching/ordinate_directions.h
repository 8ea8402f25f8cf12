// Directions and weights of a quadrature over the sphere, for discrete ordinates and for directional transmittances.
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::compensated_ray_marching {

struct Ordinate {
  Vec3 direction;  // unit
  double weight;   // [sr]; they sum to 4 pi
};

// Levels in cos(theta), about the world's z axis, times equally spaced azimuths. `hemispheres`: Gauss-Legendre on [-1, 0] and on [0, 1], so
// that `levels` on each side know of a face that light enters through; else over the whole of [-1, 1]. Exact for spherical harmonics of
// degree d where the rule in cos(theta) is exact for degree d and there are more than d azimuths. levels >= 1, azimuths >= 1.
std::vector<Ordinate> ordinate_directions(int levels, int azimuths, bool hemispheres);

}  // namespace airlight::compensated_ray_marching
