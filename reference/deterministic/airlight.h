// Light that a ray collects by exactly one scattering in the medium and nothing else, from delta lights: order (1, 0),
// as a one-dimensional integral without noise (spec/references.md, section 3, item 10):
//
//   L = sum over lights, media  int  albedo extinction(t) phase(c) E(t) exp(-depth(0, t) - depth(t, light)) visible(t)
//   dt
//
// Adaptive Gauss-Kronrod over panels that are cut wherever the integrand has a kink, in equal angles as seen from a
// point or spot light. Any combination of media.
#pragma once
#include <memory>

#include "scene/scene.h"

namespace airlight::deterministic {

struct Accuracy {
  double relative_tolerance = 1e-10;  // of the sum over lights, per channel
  long max_evaluations = 200000;      // of the integrand, per ray
};

struct Airlight {
  Rgb radiance = Rgb::Zero();  // [W/m^2/sr]; infinite if the ray meets a light of radius 0 inside a medium
  Rgb error = Rgb::Zero();     // estimate, absolute
  long evaluations = 0;
  bool converged = true;  // the tolerance was met; also false where the radiance is infinite
};

// Precomputed values of a scene; one object serves all threads. Environment lights are left out: they
// are not delta lights.
class AirlightIntegrator {
 public:
  AirlightIntegrator(const scene::Scene&, const Accuracy&);  // keeps a reference to the scene
  ~AirlightIntegrator();

  // Airlight over 0 < t < t_end of the ray; t_end may be infinite. Objects beyond t_end do not matter to the view path;
  // light paths see all media and surfaces.
  Airlight operator()(const Ray&, double t_end) const;

  // All media between the origin and t; noise-free.
  Rgb optical_depth(const Ray&, double t) const;

  // From a point to a delta light, through all media (infinite for an unbounded one and a directional light).
  Rgb light_depth(const Point3&, int light) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// For single rays: prepares and integrates.
Airlight airlight(const scene::Scene&, const Ray&, double t_end, const Accuracy& = {});

}  // namespace airlight::deterministic
