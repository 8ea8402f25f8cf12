// The paper's airlight of one ray, written out as in the text: Zhou et al. 2007, Eqs. 8 to 17. This is the form to read
// and to check against; pictures use the same formulas on vectors (paper_ray.h).
#pragma once
#include "methods/fogshop/f_table.h"
#include "scene/media/gaussian_sum.h"

namespace airlight::fogshop {

// T_i(a, b): optical depth of one Gaussian between two points [-].
double optical_depth(const scene::Gaussian&, const Point3& a, const Point3& b);

// T(a, b), Eq. 3: of the whole medium [-]. Here and below the amplitudes and the constant are extinctions [1/m].
double optical_depth(const scene::GaussianSum&, const Point3& a, const Point3& b);

struct PaperOptions {
  double source_radius = 0;         // r_s [m]: 1/d^2 becomes 1/(d^2 + r_s^2)
  const FTable* f_table = nullptr;  // F from the paper's table instead of its closed form; r_s must be 0
  double g = 0;                     // of Henyey-Greenstein's phase function, in the Gaussian terms; 0: isotropic
};

// 4 pi times Henyey-Greenstein's phase function, k(alpha) of Eq. 2: 1 where g is 0. `cosine`: of the angle by which light turns.
double relative_phase(double g, double cosine);

// Airlight [W/m^2/sr] over [0, d_r] of the ray from an isotropic point light at s of `intensity` [W/sr], albedo 1. d_r may be
// infinite. The airlight is infinite where the formula is: a light on the ray in a constant medium, or at the camera.
double paper_airlight(const scene::GaussianSum&, const Point3& s, double intensity, const Ray&, double d_r,
                      const PaperOptions& = {});

}  // namespace airlight::fogshop
