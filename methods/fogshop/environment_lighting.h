// Light from an environment, in harmonics: Zhou et al. 2007, section 4.2, Eqs. 26 to 28.
//
// The light that a medium scatters is the environment convolved with a point spread function, one product per
// coefficient (Eq. 21), times T e^-T of one optical depth T. The paper takes T along the view ray for airlight (Eq.
// 28). For light that reaches a surface it averages T over all directions (Eq. 26): it treats the medium around a point
// as a ball of that depth.
#pragma once
#include "methods/fogshop/depth_tree.h"
#include "methods/fogshop/environment_psf.h"
#include "methods/fogshop/model.h"

namespace airlight::fogshop {

// Radiance that reaches a point, order^2 coefficients each [W/m^2/sr], of directions towards the light.
struct IncidentHarmonics {
  std::vector<Rgb> attenuated;  // e^-T L: not scattered
  std::vector<Rgb> scattered;  // albedo T e^-T (L * PSF): scattered once; empty where there is no medium or if left out
};

class EnvironmentLighting {
 public:
  // All environment lights of the scene together. `spreads`: something scatters, else the PSF is not tabulated. `before`: of a frame with
  // the same options, whose table of the PSF is kept; may be null.
  EnvironmentLighting(const scene::Scene&, const Options&, bool spreads, const EnvironmentLighting* before = nullptr);

  // Eq. 28: light of the environment scattered once towards the eye along a ray that no surface ends [W/m^2/sr], the
  // medium's albedo included. `direction` is the ray's, `depth` T(v,p) [-] for an extinction ratio of 1. Has no direct term. Bands
  // cut off may swing below 0: then it is 0.
  Rgb airlight(const Fog&, double depth, const Vec3& direction) const;

  // Eq. 27 for an average depth T of the point (Eq. 26) [-], at extinction ratio 1.
  IncidentHarmonics incident(const Fog&, double depth, bool scattered) const;

  const std::vector<Rgb>& light() const { return light_; }
  bool spreads() const { return bands_ != nullptr; }
  const PsfBands& bands() const { return *bands_; }  // requires spreads
  int order() const { return order_; }

 private:
  // sqrt(4 pi / (2l+1)) g_l T e^-T of Eqs. 21, 27 and 28 by band and channel, albedo included.
  std::vector<Rgb> spread(const Fog&, double depth) const;

  int order_;
  std::vector<Rgb> light_;  // L_lm
  std::shared_ptr<const PsfBands> bands_;
};

// Eq. 26: optical depth from a point to the environment, averaged over all directions [-], at extinction ratio 1; the constant reaches
// Options::environment_distance far. By the tree where there is one (then the point is on a surface), else all Gaussians
// are summed: the average falls as 1/distance^2 only.
double average_depth(const Model&, const Point3&, const DepthTree* = nullptr);

// Distances to a finite environment for view rays that no surface ends: these replace infinite distances.
std::vector<double> up_to_environment(const Options&, std::vector<double> distance);

// Last loop of section 5.3, and Eq. 29 with L_p = L_in: adds Eq. 28 to `airlight` and the background, seen through the
// medium, to `surface`, of every pixel whose ray nothing ends (Eq. 28 of all pixels with `everywhere`). `distance` [m]
// is infinite there; `depth` is T(v,p). `lighting` may be null: then there is no airlight.
void environment_pass(const scene::Scene&, const Model&, const EnvironmentLighting* lighting, const scene::View&,
                      const std::vector<double>& distance, const std::vector<double>& depth, const scene::Execution&,
                      std::vector<float>& airlight, std::vector<float>& surface);

}  // namespace airlight::fogshop
