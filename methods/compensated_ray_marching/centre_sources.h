// Source radiance at the centres of the Gaussians, as the publication finds it: single scattering in harmonics, then the diffusion system.
// Zhou et al. 2008, sections 5.3 and 5.4; shadows of objects, as spheres, on smoke and of both on surfaces.
#pragma once
#include <optional>

#include "methods/compensated_ray_marching/environment_bands.h"
#include "methods/compensated_ray_marching/options.h"
#include "methods/compensated_ray_marching/warm_start.h"
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {

// Why multiple scattering at the centres is left out; empty if it is not. Its upper bound is the albedo
// times the light lost on a path along the axes of all Gaussians, one after another. It is not computed
// if the bound is below the tolerance.
std::string single_only(const scene::GaussianSum&, const scene::Medium&, const Options&);

class CentreSources {
 public:
  // `sum` and `medium` describe one smoke and must outlive this object. Gaussians of amplitude 0 are skipped. Spheres
  // cast shadows, meshes cast shadows as sets of spheres, planes cast none.
  CentreSources(const scene::GaussianSum& sum, const scene::Medium& medium, const std::vector<scene::Surface>&,
                const Options&);

  // Sets the lights. Conjugate gradients start from the previous radiance. `scatters`: whether the smoke scatters
  // light; without it all sources are 0, and only light on surfaces is computed.
  void light(const std::vector<scene::Light>&, bool scatters, const scene::Execution&);
  // Where the first light begins: with the solution of the last frame's smoke, which `solution` gives.
  void begin_with(const Solution&);
  Solution solution() const;

  // At each centre, towards the camera, at least 0 where it is asked for between centres [W/m^2/sr].
  std::vector<Rgb> towards(const scene::Camera&) const;

  // Irradiance at a point of a surface [W/m^2]: past the smoke and the other objects.
  Rgb irradiance(const Point3&, const Vec3& normal, int surface) const;
  std::size_t objects() const { return objects_.size(); }
  const std::string& single_only() const { return single_only_; }  // of the free function

  const std::vector<std::vector<Rgb>>& sources() const {
    return sources_;
  }  // order^2 coefficients, propagation directions
  const std::vector<scene::StageTime>& times() const { return times_; }
  int iterations() const { return iterations_; }             // of all channels
  double residual() const { return residual_; }              // the greatest, relative
  double negative_share() const { return negative_share_; }  // of the centres' scattered radiance, taken as 0

 private:
  void scatter_again();

  const scene::GaussianSum& sum_;
  const scene::Medium& medium_;
  Options options_;
  EnvironmentBands bands_;
  std::string single_only_;
  std::vector<scene::Sphere> objects_;
  std::vector<int> surface_of_;             // of each object
  std::optional<SourceRadiance> radiance_;  // of the light now
  std::vector<std::vector<Rgb>> sources_;
  std::vector<Eigen::VectorXd> mean_radiance_;  // of each channel, at the centres; first that of the frame before
  std::vector<scene::StageTime> times_;
  int iterations_ = 0;
  double residual_ = 0, negative_share_ = 0;
};

}  // namespace airlight::compensated_ray_marching
