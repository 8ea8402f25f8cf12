// Functions of real spherical harmonics that depend on the angle to an axis alone (zonal: a coefficient a band), and what Zhou et al. 2008
// do with them (section 3).
#pragma once
#include <vector>

#include "scene/math/types.h"
#include "scene/phase.h"

namespace airlight::compensated_ray_marching {

// The zonal function about an axis (unit): order^2 coefficients sqrt(4 pi / (2l+1)) z_l y_lm(axis).
std::vector<double> about_axis(const std::vector<double>& zonal, const Vec3& axis);

// Convolution of a function with a zonal one: sqrt(4 pi / (2l+1)) f_lm z_l.
std::vector<double> convolved(const std::vector<double>& f, const std::vector<double>& zonal);

// Henyey-Greenstein, normalised to 4 pi: sqrt(4 pi (2l+1)) g^l.
std::vector<double> henyey_greenstein(int order, double g);

// Mean of P_l over a phase function, l < order: what it leaves of band l.
std::vector<double> phase_moments(const scene::PhaseFunction&, int order);

// f(-w): band l times (-1)^l. From lookup directions to propagation directions, and back.
std::vector<double> turned_back(std::vector<double> f);

}  // namespace airlight::compensated_ray_marching
