// Variant VS2: one Gaussian over the squared distance from the light, along the whole ray, in closed form. The integral
//
//   of  exp(-a^2 (t - m)^2) / ((t - t_s)^2 + h^2) dt  is  pi/h Re w(X + iY),   X = a (t_s - m),  Y = a h,
//
// w the Faddeeva function (the profile is Voigt's), and w gives the first three moments too. What attenuates the light
// on its way is taken at the two nodes of the Gauss rule with these moments.
#pragma once
#include <vector>

#include "methods/fogshop/kernels.h"

namespace airlight::fogshop {

// Moments of u = a (t - m) under the density exp(-u^2) / ((X - u)^2 + Y^2), normalised.
struct VoigtMoments {
  double integral;               // of that density over u, not normalised
  double mean, variance, third;  // central
};
// Any X, Y > 0. Relative error of the integral below 1e-12, of the moments (by the scale of their powers of the
// standard deviation) below 1e-8.
VoigtMoments voigt_moments(double X, double Y);

struct VoigtNode {
  double t;       // [m]
  double weight;  // [1/m^2]: the sum over a Gaussian's nodes is the integral of its extinction over d^2
  int crossing;
};

// Appends the two nodes of one crossed Gaussian. Where an end of the ray [0, length] cuts it within three widths of its
// middle the moments are those of the part that is left, by quadrature. The light stands at ray parameter `along`, `h`
// away.
void append_voigt_nodes(const Crossings&, int crossing, double length, double along, double h,
                        std::vector<VoigtNode>& nodes);

}  // namespace airlight::fogshop
