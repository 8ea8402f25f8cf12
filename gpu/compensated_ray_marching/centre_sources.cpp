#include "gpu/compensated_ray_marching/centre_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/view_uniforms.h"
#include "methods/compensated_ray_marching/centre_sources.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::Caster;
using airlight::compensated_ray_marching::Options;

constexpr int lanes = 64;  // invocations of a work group

std::string at_index(const char* name, std::size_t i) { return fmt::format("{}[{}]", name, i); }

std::vector<scene::Sphere> spheres_of(const std::vector<Caster>& casters) {
  std::vector<scene::Sphere> spheres;
  for (const Caster& caster : casters) spheres.push_back(caster.sphere);
  return spheres;
}

// Spheres with their surface, then what each surface reflects.
std::vector<double> objects_of(const std::vector<Caster>& casters, const std::vector<scene::Surface>& surfaces) {
  std::vector<double> values;
  for (const auto& [sphere, surface] : casters)
    for (const double v : {sphere.center[0], sphere.center[1], sphere.center[2], sphere.radius, double(surface)})
      values.push_back(v);
  const Vec3 any = Vec3::UnitY();
  for (const scene::Surface& surface : surfaces)
    for (const double v : scene::brdf(surface.material, any, any, any)) values.push_back(v);
  return values;
}

}  // namespace

CentreSourcesOnDevice::CentreSourcesOnDevice(Context& context, const scene::GaussianSum& sum,
                                             const scene::Medium& medium, const std::vector<scene::Surface>& surfaces,
                                             bool scatters, const SmokeDensity* density, const Point3& middle,
                                             const Options& options, StageTimer& timer,
                                             const scene::Execution& execution)
    : context_(context),
      medium_(medium),
      options_(options),
      single_only_(airlight::compensated_ray_marching::single_only(sum, medium, options)),
      gaussians_(sum.gaussians),
      count_(int(sum.gaussians.size())),
      casters_(airlight::compensated_ray_marching::casters_of(surfaces, options.paper.mesh_spheres)),
      objects_(int(casters_.size())),
      scatters_(count_ > 0 && scatters),
      tables_(context, options.order, options.paper.transmittance, sum.cutoff, objects_ > 0),
      moments_(airlight::compensated_ray_marching::phase_moments(medium.phase, options.order)) {
  std::vector<double> values;
  for (const scene::Gaussian& g : sum.gaussians)
    for (const double v : {g.center[0], g.center[1], g.center[2], g.width, g.amplitude}) values.push_back(v);
  centres_ = std::make_unique<Buffer>(context, "centres", values);
  spheres_ = std::make_unique<Buffer>(context, "spheres that cast shadows", objects_of(casters_, surfaces));
  if (options.paper.transmittance == airlight::compensated_ray_marching::Transmittance::directional)
    directions_ = airlight::compensated_ray_marching::transmittance_directions();
  const auto bands = std::size_t(options.order) * options.order, n = std::size_t(count_);
  const std::size_t parts = directions_.empty() ? bands : directions_.size();
  light_bands_ = std::make_unique<Buffer>(context, "light in bands", 8 * 3 * parts);
  sources_ = std::make_unique<Buffer>(context, "sources of centres", 16 * n);
  find_extinctions();
  if (!surfaces.empty() && directions_.empty()) surfaces_program_ = program_of("centre_surfaces", lanes, 1);
  if (!surfaces.empty() && !directions_.empty())
    surfaces_by_directions_ = std::make_unique<SurfacesByDirections>(context, density, middle, directions_);
  if (!scatters_) return;
  if (directions_.empty()) passed_program_ = program_of("centre_passed", lanes, 1);
  single_program_ = program_of("centre_single", lanes, 1);
  towards_program_ = program_of("centre_towards", lanes, 1);
  passed_ = std::make_unique<Buffer>(context, "what passes to centres", 8 * n * parts * extinctions_.size());
  single_ = std::make_unique<Buffer>(context, "single scattering at centres", 8 * n * bands * 3);
  again_ = std::make_unique<Buffer>(context, "scattered again at centres", 8 * n * 4 * 3);
  timer.begin("passing light");
  if (directions_.empty())
    find_passed();
  else
    passed_->upload(passed_by_directions(sum, spheres_of(casters_), execution));
  if (!single_only_.empty()) return;
  timer.begin("diffusion matrix");
  diffusion_ =
      std::make_unique<CentreDiffusion>(context, tables_, *centres_, *single_, *again_, gaussians_, medium_, options_);
}

void CentreSourcesOnDevice::find_extinctions() {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto same = std::find(extinctions_.begin(), extinctions_.end(), medium_.sigma_t[Eigen::Index(c)]);
    extinction_of_[c] = int(same - extinctions_.begin());
    if (same == extinctions_.end()) extinctions_.push_back(medium_.sigma_t[Eigen::Index(c)]);
  }
}

// A program that knows the tables.
Program* CentreSourcesOnDevice::program_of(const char* file, int x, int y, Definitions more) {
  more.insert(tables_.definitions().begin(), tables_.definitions().end());
  return &program(context_, file, x, y, more);
}

void CentreSourcesOnDevice::find_passed() {
  Program& p = *passed_program_;
  tables_.bind(p);
  tables_.bind_terms();
  centres_->bind(at::centres);
  spheres_->bind(at::spheres);
  passed_->bind(at::passed);
  p.set("gaussian_count", count_);
  p.set("sphere_count", objects_);
  p.set("extinctions", int(extinctions_.size()));
  for (std::size_t e = 0; e < extinctions_.size(); ++e) p.set_double(at_index("extinction", e), extinctions_[e]);
  p.dispatch(lanes * count_);
}

// Once for a smoke, and in double precision, which error functions of shaders have not.
std::vector<double> CentreSourcesOnDevice::passed_by_directions(const scene::GaussianSum& sum,
                                                                const std::vector<scene::Sphere>& objects,
                                                                const scene::Execution& execution) const {
  scene::GaussianSum smoke = sum;
  smoke.constant = 0;
  const std::size_t n = smoke.gaussians.size(), parts = directions_.size();
  std::vector<double> passed(n * parts * extinctions_.size());  // [extinction][direction][centre]
  scene::parallel_for(int(n), execution, [&](int i) {
    for (std::size_t k = 0; k < parts; ++k) {
      const Ray ray{smoke.gaussians[std::size_t(i)].center, directions_[k].direction};
      const double share = airlight::compensated_ray_marching::visible_share(objects, ray.origin, ray.direction,
                                                                             std::sqrt(4 * pi / double(parts)));
      const double column = density_integral(smoke, ray, {0, infinity});
      for (std::size_t e = 0; e < extinctions_.size(); ++e)
        passed[(e * parts + k) * n + std::size_t(i)] = share * std::exp(-extinctions_[e] * column);
    }
  });
  return passed;
}

void CentreSourcesOnDevice::scatter_once() {
  Program& p = *single_program_;
  tables_.bind_terms();
  passed_->bind(at::passed);
  light_bands_->bind(at::light_bands);
  single_->bind(at::single_bands);
  p.set("gaussian_count", count_);
  const int bands = options_.order * options_.order;
  for (std::size_t c = 0; c < 3; ++c) {
    p.set(at_index("extinction_of", c), extinction_of_[c]);
    p.set_double(at_index("albedo", c), medium_.albedo[Eigen::Index(c)]);
  }
  for (std::size_t b = 0; b < std::size_t(bands); ++b) {
    const auto band = std::size_t(std::sqrt(double(b)));  // from towards the light to along it
    p.set_double(at_index("moment", b), (band % 2 ? -1 : 1) * moments_[band]);
  }
  p.dispatch(count_, bands, 3);
}

void CentreSourcesOnDevice::light(const std::vector<Rgb>& light, StageTimer& timer, const scene::Execution& execution) {
  if (!scatters_ && !surfaces_program_ && !surfaces_by_directions_) return;
  timer.begin("upload");
  std::vector<Rgb> parts = light;
  if (!directions_.empty()) parts.clear();
  for (const auto& d : directions_) parts.push_back(d.weight * scene::evaluate_sh(light, d.direction));
  std::vector<double> values;
  bool grey = true;
  for (int c = 0; c < 3; ++c)
    for (const Rgb& part : parts) {
      values.push_back(part[c]);
      grey = grey && part[c] == part[0];
    }
  light_bands_->upload(values);
  if (!scatters_) return;
  timer.begin("single scattering");
  scatter_once();
  if (!diffusion_ || diffusion_->empty()) return;
  timer.begin("multiple scattering");
  diffusion_->scatter_again(grey, execution);
}

void CentreSourcesOnDevice::towards(const scene::View& view) {
  if (!scatters_) return;
  Program& p = *towards_program_;
  tables_.bind(p);
  centres_->bind(at::centres);
  single_->bind(at::single_bands);
  again_->bind(at::again);
  sources_->bind(at::centre_sources);
  p.set("gaussian_count", count_);
  p.set("perspective_", view.camera.kind == scene::Camera::Kind::perspective);
  p.set_double("eye", view.camera.position);
  p.set_double("forward", view.camera.forward);
  p.dispatch(count_);
}

void CentreSourcesOnDevice::light_surfaces(const scene::View& view, const SurfacesOnDevice& surfaces,
                                           const Buffer& primitives, const Buffer& lit) {
  if (surfaces_by_directions_) {
    surfaces_by_directions_->light(view, surfaces, medium_.sigma_t, *light_bands_, *spheres_, objects_, primitives,
                                   lit);
    return;
  }
  Program& p = *surfaces_program_;
  tables_.bind(p);
  tables_.bind_terms();
  centres_->bind(at::centres);
  spheres_->bind(at::spheres);
  light_bands_->bind(at::light_bands);
  primitives.bind(at::primitives);
  lit.bind(at::lit);
  surfaces.bind();
  set_view(p, view);
  p.set("gaussian_count", count_);
  p.set("sphere_count", objects_);
  p.set("triangle_count", surfaces.triangles());
  for (std::size_t c = 0; c < 3; ++c) p.set_double(at_index("extinction", c), medium_.sigma_t[Eigen::Index(c)]);
  const std::vector<double> cosine = airlight::compensated_ray_marching::cosine_zonal(options_.order);
  for (std::size_t l = 0; l < cosine.size(); ++l)
    p.set_double(at_index("cosine", l), cosine[l] * about_axis_factor(int(l)));
  p.dispatch(lanes * view.width, view.height);
}

}  // namespace airlight::gpu::compensated_ray_marching
