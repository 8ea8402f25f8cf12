// The medium of a scene in the form of Zhou et al. 2007, Eqs. 6 and 7: one constant and one list of Gaussians.
#pragma once
#include <string>
#include <vector>

#include "scene/media/gaussian_sum.h"
#include "scene/scene.h"

namespace airlight::fogshop {

// extinction per channel = extinction_ratio * (constant + sum of Gaussians). Channels of one colour differ only by that factor, so
// every optical depth is computed once and scaled.
struct Fog {
  scene::GaussianSum sum;  // amplitudes and constant are extinctions [1/m] where `extinction_ratio` is 1; no cutoff
  Rgb extinction_ratio = Rgb::Ones();  // [-], the greatest is 1
  Rgb albedo = Rgb::Ones();            // of everything, or the greatest of all where they differ
  // Scattering of each Gaussian relative to `albedo`, in [0, 1]; empty if all albedos are equal. It scales the
  // scattering and not the extinction: the "color" of the paper's sections 6 and 7.
  std::vector<Rgb> colours;
  Rgb constant_colour = Rgb::Ones();
  double g = 0;  // mean cosine of the phase function, Henyey-Greenstein's; 0: isotropic

  bool grey() const { return (extinction_ratio == 1).all(); }
  bool one_albedo() const { return colours.empty(); }
  bool empty() const { return sum.gaussians.empty() && !(sum.constant > 0); }
};

// Why these media are none such; empty if they are. Accepted: any number of homogeneous media and Gaussian sums, each
// unbounded, without negative amplitudes or a cutoff that shows (below 6 widths, e^-36 of the peak), with sigma_t that
// differ by a factor and one phase function: isotropic, or of Gaussians alone Henyey-Greenstein's; albedos may differ.
// Media that do not extinguish are ignored.
std::vector<std::string> unsupported_media(const std::vector<scene::Medium>&);

// Requires that unsupported_media() names none.
Fog make_fog(const std::vector<scene::Medium>&);

}  // namespace airlight::fogshop
