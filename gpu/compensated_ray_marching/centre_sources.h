// Source radiance at the centres of the Gaussians, on the device:
// methods/compensated_ray_marching/centre_sources.h. Transmittances and the diffusion system's matrix
// are computed once; a light that turns uploads its harmonics. In double precision, because the system
// squares condition numbers of a thousand, which amplifies the rounding of its right side.
#pragma once
#include <array>

#include "gpu/compensated_ray_marching/centre_diffusion.h"
#include "gpu/compensated_ray_marching/centre_tables.h"
#include "gpu/compensated_ray_marching/surfaces_by_directions.h"
#include "gpu/raster/first_hits.h"
#include "gpu/timer.h"
#include "methods/compensated_ray_marching/options.h"
#include "methods/compensated_ray_marching/sphere_sets.h"
#include "scene/renderer.h"

namespace airlight::gpu::compensated_ray_marching {

class CentreSourcesOnDevice {
 public:
  // `sum` and `medium` describe one smoke, with amplitudes above 0; the medium must outlive this object. Spheres cast
  // shadows, meshes cast shadows as sets of spheres, planes cast none. The density is the one that is marched through,
  // for light on surfaces (null: no smoke), and must outlive this object; `middle` is its middle. Stages of the timer:
  // what passes, the matrices. Throws Unavailable where the device has no room.
  CentreSourcesOnDevice(Context&, const scene::GaussianSum& sum, const scene::Medium& medium,
                        const std::vector<scene::Surface>&, bool scatters, const SmokeDensity*, const Point3& middle,
                        const airlight::compensated_ray_marching::Options&, StageTimer&, const scene::Execution&);

  // Sets the light: order^2 coefficients of lookup directions. Conjugate gradients start from the previous radiance.
  // The host first submits as many iterations as were needed last time, then checks convergence.
  void light(const std::vector<Rgb>& harmonics, StageTimer&, const scene::Execution&);

  // Where the first light begins: with the solution of the last frame's smoke, which `solution` downloads.
  void begin_with(const airlight::compensated_ray_marching::Solution& last) {
    if (diffusion_) diffusion_->begin_with(last);
  }
  airlight::compensated_ray_marching::Solution solution() const {
    return diffusion_ ? diffusion_->solution() : airlight::compensated_ray_marching::Solution{};
  }

  // Computes the radiance of each centre towards the camera, of either sign, into sources() [W/m^2/sr].
  void towards(const scene::View&);
  const Buffer& sources() const { return *sources_; }

  // Light that Lambertian surfaces reflect, written into Lit of every pixel.
  void light_surfaces(const scene::View&, const SurfacesOnDevice&, const Buffer& primitives, const Buffer& lit);

  int centres() const { return count_; }
  int objects() const { return objects_; }
  // Why multiple scattering is left out; empty where it is not.
  const std::string& single_only() const { return single_only_; }
  // Statistics of the solver for multiple scattering.
  int iterations() const { return diffusion_ ? diffusion_->iterations() : 0; }
  double residual() const { return diffusion_ ? diffusion_->residual() : 0; }
  double negative_share() const { return diffusion_ ? diffusion_->negative_share() : 0; }

 private:
  Program* program_of(const char* file, int x, int y, Definitions more = {});
  void find_extinctions();
  void find_passed();
  std::vector<double> passed_by_directions(const scene::GaussianSum&, const std::vector<scene::Sphere>&,
                                           const scene::Execution&) const;
  void scatter_once();

  Context& context_;
  const scene::Medium& medium_;
  airlight::compensated_ray_marching::Options options_;
  std::string single_only_;
  std::vector<scene::Gaussian> gaussians_;
  int count_ = 0;
  std::vector<airlight::compensated_ray_marching::Caster> casters_;
  int objects_ = 0;
  bool scatters_ = false;
  CentreTables tables_;
  std::vector<airlight::compensated_ray_marching::Ordinate> directions_;  // of `directional`
  std::vector<double> extinctions_;
  std::array<int, 3> extinction_of_{0, 0, 0};
  std::vector<double> moments_;
  Program *passed_program_ = nullptr, *single_program_ = nullptr, *towards_program_ = nullptr,
          *surfaces_program_ = nullptr;
  std::unique_ptr<SurfacesByDirections> surfaces_by_directions_;
  std::unique_ptr<Buffer> centres_, spheres_, passed_, light_bands_, single_, again_, sources_;
  std::unique_ptr<CentreDiffusion> diffusion_;
};

}  // namespace airlight::gpu::compensated_ray_marching
