// Light of a sun that the fog scatters once: shadows of fog in fog, and of what stands in it. Named as future work by
// Giroud and Biri 2010, section 5.
//
//   L = sum over suns, media  integral  albedo extinction(t) p(c) E exp(-depth(0, t) - depth(t, sun)) visible(t) dt
//
// along a ray, cell by cell: Gauss points of each cell, where the densities are polynomials; the transmittance to them is
// carried along, that to the sun read from one map per sun and fog (sun_map.h). Surfaces stand in the way by shadow rays.
#pragma once
#include <string>
#include <vector>

#include "methods/wavelet_fog/options.h"
#include "methods/wavelet_fog/sun_map.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::wavelet_fog {

// Counts of the rays' reads.
struct SunVisits {
  long points = 0, shadow_rays = 0;
};

// Why no sun is scattered: no fog, no directional light, or an albedo of 0 where it shines; empty if one is.
std::string why_no_sun(const scene::Scene&);

class SunScattering {
 public:
  struct Rule {  // on [0, 1]
    std::vector<double> node, weight;
    std::vector<double> upto;  // [node][term]: integral from 0 to the node of the polynomial through all terms
  };
  static Rule rule_of(int points);

  // Scatters all directional lights of the scene, which outlives this and has fogmaps alone. `before`: the scattering of the frame before,
  // whose maps are kept where they still hold; may be null.
  SunScattering(const scene::Scene&, const Options&, const scene::Execution&, const SunScattering* before = nullptr);

  int maps_made() const { return maps_made_; }  // those kept left out

  // Over 0 < t < length, which may be infinite [W/m^2/sr].
  Rgb airlight(const Ray&, double length, SunVisits&) const;

 private:
  struct Sun {
    scene::DirectionalLight light;
    std::vector<SunMap> maps;  // one for each medium
  };
  struct Along;  // a ray under a sun

  std::vector<Interval> cells(const Ray&, double length) const;
  Rgb scattered(const Sun&, const Ray&, const std::vector<Interval>& cells, SunVisits&) const;
  void add(Along&, Interval, bool lit, int halvings = 0) const;

  const scene::Geometry* geometry_;  // null without surfaces
  std::vector<const scene::Medium*> media_;
  std::vector<Sun> suns_;
  Rule rule_;
  int maps_made_ = 0;
  int shadow_steps_;
  double least_;  // transmittance at which a ray ends
};

}  // namespace airlight::wavelet_fog
