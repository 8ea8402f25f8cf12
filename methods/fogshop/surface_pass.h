// Surfaces seen through the medium: Zhou et al. 2007, Eq. 29, with L_p lit by the lights through the medium (the second
// term of Eq. 19). The scattered light that Eqs. 18 to 27 add to it joins here.
#pragma once
#include <vector>

#include "methods/fogshop/model.h"
#include "scene/scene.h"

namespace airlight::fogshop {

// A pixel's hit, kept from the first pass.
struct SurfacePoint {
  Point3 position;
  Vec3 normal;
  int surface;
};

// L_p [W/m^2/sr] towards `view`: sum over the lights of brdf cos I/d^2 e^(-T(s,p)), 0 where another surface is in the
// way.
Rgb direct_reflection(const scene::Scene&, const Model&, const SurfacePoint&, const Vec3& to_view, Crossings&,
                      double& evaluations);

}  // namespace airlight::fogshop
