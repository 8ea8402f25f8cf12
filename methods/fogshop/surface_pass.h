// Surfaces seen through the medium: Zhou et al. 2007, Eq. 29, with L_p lit by the lights through the medium (the second
// term of Eq. 19) and by what the medium scatters (scattered_reflection.h). Both backends use it.
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
  int triangle = -1;  // of the surface's mesh, if it is one
};

// Section 5.4, step 1: what ends the camera rays.
struct FirstHits {
  std::vector<double> distance;      // d_vp [m] of every pixel; infinite where nothing is hit
  std::vector<SurfacePoint> points;  // surface < 0: none
  std::vector<float> seen;           // of backdrops [W/m^2/sr], 3 a pixel, NaN where none is; empty without backdrops
};
FirstHits first_hits(const scene::Scene&, const scene::View&, const scene::Execution&);

// T(s,p) of a point light, constant included [-], at extinction ratio 1: computed once for direct and for scattered light.
struct LightDepth {
  Point3 source;
  double depth;
};
double light_depth(const Model&, const Point3& source, const Point3& point, Crossings&, double& evaluations,
                   std::vector<LightDepth>* found);

// L_p [W/m^2/sr] towards `view`: sum over the lights of brdf cos I/d^2 e^(-T(s,p)), 0 where another surface is in the
// way.
Rgb direct_reflection(const scene::Scene&, const Model&, const SurfacePoint&, const Vec3& to_view, Crossings&,
                      double& evaluations, std::vector<LightDepth>* found = nullptr);

struct SurfaceLighting;

// Steps 4 and 7: L = e^-T L_p of every pixel that a surface ends, into `surface`; the part of it that the medium had
// scattered into `scattered` too, if it is not null. Other pixels are left alone. Returns calls of the error function.
double surface_pass(const scene::Scene&, const Model&, const SurfaceLighting&, const scene::View&,
                    const std::vector<SurfacePoint>&, const std::vector<float>& transmittance, const scene::Execution&,
                    std::vector<float>& surface, std::vector<float>* scattered);

}  // namespace airlight::fogshop
