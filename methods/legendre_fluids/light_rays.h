// Light that a ray collects by one scattering, where optical depths are exact: spec section 9, in place of the paper's systems.
//
//   L = sum over lights, media  integral  albedo sigma_t r(t) p(c) E exp(-tau_view(t) - tau_light(t)) visible(t) dt
//
// The ray is cut where it enters and leaves boxes, and at the planes where light comes in by another face. Between two cuts density and
// both depths are polynomials: their values at as many Gauss points as they have coefficients give them as Legendre series, and panels
// (light_panels.h) integrate those. Where a density is negative the ray is also cut at its sign changes, and halved until the depth towards
// the light, which then has kinks, is a polynomial to the tolerance.
#pragma once
#include "methods/legendre_fluids/light_panels.h"
#include "methods/legendre_fluids/lit_media.h"

namespace airlight::legendre_fluids {

struct RayOptions {
  int points = 8;                    // of a panel
  double tolerance = 1e-5;           // relative, of a light's share of the radiance
  int shadow_steps = 64;             // shadow rays over the media on a ray, where surfaces may stand before a light
  int environment_directions = 256;  // that stand for each environment
};

// Statistics of rays, and working memory of a thread.
struct RayVisits {
  long segments = 0, shadow_rays = 0;
  PanelRule::Work work;
  void operator+=(const RayVisits& more) {
    segments += more.segments;
    shadow_rays += more.shadow_rays;
    work.panels += more.work.panels;
  }
};

class LightRays {
 public:
  // Keeps a reference to the scene. With `before`, the light of the frame before under the same options, what has not changed is shared.
  LightRays(const scene::Scene&, const RayOptions&, const LightRays* before = nullptr);
  const LitMedia& media() const { return media_; }
  int columns_made() const { return columns_made_; }  // of a medium towards a light; others are of the frame before
  double negative_share() { return media_.greatest_negative_share(); }
  bool shadowed() const;  // can surfaces stand before a light at all

  // Over 0 < t < end, which may be infinite [W/m^2/sr].
  Rgb airlight(const Ray&, double end, RayVisits&) const;

 private:
  struct Walk;  // of one ray under one light
  struct Visibility {
    bool first = true;  // lit where the ray begins
    std::vector<double> changes;
  };
  std::vector<double> cuts(const Ray&, double end, std::size_t light) const;
  Visibility visibility(const Ray&, Interval, std::size_t light, RayVisits&) const;

  const scene::Geometry* geometry_;
  RayOptions options_;
  LitMedia media_;
  int columns_made_;
  PanelRule rule_;
  std::vector<bool> shadowed_;  // by light
};

}  // namespace airlight::legendre_fluids
