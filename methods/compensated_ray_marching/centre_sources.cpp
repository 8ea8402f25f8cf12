#include "methods/compensated_ray_marching/centre_sources.h"

#include <fmt/format.h>

#include <cmath>

#include "methods/compensated_ray_marching/diffusion_system.h"
#include "methods/compensated_ray_marching/sphere_sets.h"
#include "methods/compensated_ray_marching/to_camera.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/stopwatch.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {

std::string single_only(const scene::GaussianSum& sum, const scene::Medium& medium, const Options& options) {
  if (options.paper.multiple == Options::Paper::Multiple::none) return "not asked for";
  double column = 0;  // [m]
  for (const scene::Gaussian& g : sum.gaussians) column += std::sqrt(pi) * g.width * std::abs(g.amplitude);
  double most = 0;  // as a share of the light
  for (int c = 0; c < 3; ++c) most = std::max(most, -medium.albedo[c] * std::expm1(-medium.sigma_t[c] * column));
  return most < options.tolerance ? fmt::format("at most {:.2g} of the light is scattered again", most) : "";
}

CentreSources::CentreSources(const scene::GaussianSum& sum, const scene::Medium& medium,
                             const std::vector<scene::Surface>& surfaces, const Options& options)
    : sum_(sum),
      medium_(medium),
      options_(options),
      bands_(options.order),
      single_only_(compensated_ray_marching::single_only(sum, medium, options)) {
  for (const Caster& caster : casters_of(surfaces, options.paper.mesh_spheres)) {
    objects_.push_back(caster.sphere);
    surface_of_.push_back(caster.surface);
  }
}

Rgb CentreSources::irradiance(const Point3& x, const Vec3& normal, int surface) const {
  return radiance_->irradiance(x, normal, [&](std::size_t object) { return surface_of_[object] != surface; });
}

void CentreSources::light(const std::vector<scene::Light>& lights, bool scatters, const scene::Execution& execution) {
  scene::Stopwatch watch;
  times_.clear();
  SourceLight light{bands_.of(lights), {}};
  light.radiance = [harmonics = light.harmonics](const Vec3& w) { return scene::evaluate_sh(harmonics, w); };
  radiance_.emplace(sum_, medium_.sigma_t, medium_.albedo, phase_moments(medium_.phase, options_.order),
                    std::move(light), options_.paper.transmittance, transmittance_directions(), objects_);
  sources_.resize(sum_.gaussians.size());
  times_.push_back({"environment", watch.lap()});
  iterations_ = 0;
  residual_ = negative_share_ = 0;
  if (!scatters) {
    sources_.assign(sources_.size(), std::vector<Rgb>(1, Rgb::Zero()));
    return;
  }
  scene::parallel_for(int(sources_.size()), execution,
                      [&](int i) { sources_[std::size_t(i)] = radiance_->at(sum_.gaussians[std::size_t(i)].center); });
  times_.push_back({"single scattering", watch.lap()});
  if (!single_only_.empty()) return;
  scatter_again();
  times_.push_back({"multiple scattering", watch.lap()});
}

void CentreSources::begin_with(const Solution& last) {
  if (last.empty()) return;
  mean_radiance_.assign(3, Eigen::VectorXd::Zero(Eigen::Index(sum_.gaussians.size())));
  for (int c = 0; c < 3; ++c)
    if (Eigen::VectorXd start = at_centres(last, c, sum_.gaussians); start.size() > 0)
      mean_radiance_[std::size_t(c)] = std::move(start);
}

Solution CentreSources::solution() const {
  Solution now;
  now.centres = sum_.gaussians;
  for (std::size_t c = 0; c < mean_radiance_.size(); ++c) now.of_channel[c] = mean_radiance_[c];
  return now;
}

void CentreSources::scatter_again() {
  const DiffusionForm form = options_.paper.multiple == Options::Paper::Multiple::as_printed ? DiffusionForm::as_printed
                                                                                             : DiffusionForm::corrected;
  const double g = mean_cosine(medium_.phase), of_one = std::sqrt(4 * pi), of_direction = std::sqrt(4 * pi / 3);
  const auto n = Eigen::Index(sources_.size());
  mean_radiance_.resize(3, Eigen::VectorXd::Zero(n));
  const std::vector<std::vector<Rgb>> single = sources_;
  Eigen::Index negative = 0;
  for (int c = 0; c < 3; ++c) {
    const double albedo = medium_.albedo[c], sigma_t = medium_.sigma_t[c];
    if (!(albedo > 0) || !(sigma_t > 0)) continue;
    std::vector<LinearSource> linear;
    for (const std::vector<Rgb>& source : single) {
      double bands[4] = {0, 0, 0, 0};
      for (std::size_t b = 0; b < std::min<std::size_t>(4, source.size()); ++b) bands[b] = source[b][c];
      linear.push_back(linear_source(bands));
    }
    const DiffusionSystem system = diffusion_system(sum_.gaussians, linear, sigma_t, albedo, g, form);
    LeastSquares solution = solve_least_squares(system, mean_radiance_[std::size_t(c)], options_.iterations,
                                                options_.tolerance, options_.paper.solver);
    iterations_ += solution.iterations;
    residual_ = std::max(residual_, solution.residual);
    negative += (solution.x.array() < 0).count();
    mean_radiance_[std::size_t(c)] = solution.x;
    const std::vector<LinearSource> radiance =
        scattered_radiance(sum_.gaussians, linear, solution.x.cwiseMax(0), sigma_t, albedo, g, form);
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      std::vector<Rgb>& source = sources_[i];
      // J_ms of Eq. 4, albedo (L0 + g L1 . w), in harmonics: f0 = sqrt(4 pi) J0, (f3, f1, f2) = sqrt(4 pi / 3) (-J1x, -J1y, J1z).
      source[0][c] += albedo * radiance[i].mean * of_one;
      if (source.size() < 4) continue;
      const Vec3 direction = albedo * g * of_direction * radiance[i].direction;
      source[3][c] -= direction[0];
      source[1][c] -= direction[1];
      source[2][c] += direction[2];
    }
  }
  negative_share_ = n > 0 ? double(negative) / double(3 * n) : 0;
}

std::vector<Rgb> CentreSources::towards(const scene::Camera& camera) const {
  std::vector<Rgb> values;
  for (std::size_t i = 0; i < sources_.size(); ++i)
    values.push_back(scene::evaluate_sh(sources_[i], to_camera(camera, sum_.gaussians[i].center)));
  return values;
}

}  // namespace airlight::compensated_ray_marching
