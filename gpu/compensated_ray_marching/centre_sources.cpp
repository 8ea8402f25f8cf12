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
using airlight::compensated_ray_marching::LeastSquaresSolver;
using airlight::compensated_ray_marching::Options;

constexpr int lanes = 64, edge = 16, summing = 256;  // invocations of a work group
constexpr int first_centre_iterations = 8;           // told to the device before any is looked at

// diffusion_vectors.glsl and diffusion_gradients.comp.
enum Vector { right, solution_vector, residual_vector, gradient, direction, along, vector_count };
enum GradientStage { stage_begin, stage_residual, stage_step, stage_turn, stage_spread };
struct SystemData {
  double square, whole, alpha, beta, diagonal, left;
  int done, iterations, negative, unused;
};

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
  const auto bands = std::size_t(options.order * options.order), n = std::size_t(count_);
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
  make_diffusion_programs();
  timer.begin("diffusion matrix");
  find_groups();
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

void CentreSourcesOnDevice::make_diffusion_programs() {
  matrix_program_ = program_of("diffusion_matrix", lanes, 1, {{"SUMS", "5"}});
  right_program_ = program_of("diffusion_right", lanes, 1, {{"SUMS", "9"}});
  again_program_ = program_of("diffusion_again", lanes, 1, {{"SUMS", "11"}});
  product_program_ = program_of("diffusion_product", edge, edge, {{"TRANSPOSED", "0"}});
  transposed_program_ = program_of("diffusion_product", edge, edge, {{"TRANSPOSED", "1"}});
  gradients_program_ = program_of("diffusion_gradients", summing, 1,
                                  {{"LSQR", is_lsqr() ? "1" : "0"},
                                   {"STAGE_BEGIN", std::to_string(stage_begin)},
                                   {"STAGE_RESIDUAL", std::to_string(stage_residual)},
                                   {"STAGE_STEP", std::to_string(stage_step)},
                                   {"STAGE_TURN", std::to_string(stage_turn)},
                                   {"STAGE_SPREAD", std::to_string(stage_spread)}});
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

// Channels that scatter nothing have no system.
void CentreSourcesOnDevice::find_groups() {
  const auto n = std::size_t(count_);
  int systems = 0;
  for (int c = 0; c < 3; ++c) {
    const double sigma_t = medium_.sigma_t[c], albedo = medium_.albedo[c];
    if (!(albedo > 0) || !(sigma_t > 0)) continue;
    const auto known = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) {
      return sigma_t == medium_.sigma_t[g.channels[0]] && albedo == medium_.albedo[g.channels[0]];
    });
    if (known != groups_.end())
      known->channels.push_back(c);
    else
      groups_.emplace_back().channels = {c};
  }
  const LeastSquaresSolver solver = options_.paper.solver;
  const double g = mean_cosine(medium_.phase);
  for (Group& group : groups_) {
    group.first = systems;
    systems += int(group.channels.size());
    group.matrix = std::make_unique<Buffer>(context_, "diffusion matrix", 8 * n * n, Contents::undefined);
    group.row_scales = std::make_unique<Buffer>(context_, "scales of rows", 8 * n, Contents::undefined);
    const double sigma_t = medium_.sigma_t[group.channels[0]], albedo = medium_.albedo[group.channels[0]];
    Program& p = *matrix_program_;
    centres_->bind(at::centres);
    group.matrix->bind(at::matrix);
    group.row_scales->bind(at::row_scales);
    p.set("gaussian_count", count_);
    p.set("scaled", solver == LeastSquaresSolver::cg_scaled || solver == LeastSquaresSolver::lsqr_scaled);
    p.set_double("transport", (1 - albedo * g) * sigma_t);
    p.set_double("absorption", (1 - albedo) * sigma_t);
    p.dispatch(lanes * count_);
  }
  vectors_ = std::make_unique<Buffer>(context_, "vectors of diffusion", 8 * n * vector_count * std::size_t(systems));
  systems_ = std::make_unique<Buffer>(context_, "diffusion systems", sizeof(SystemData) * std::size_t(systems));
}

void CentreSourcesOnDevice::begin_with(const airlight::compensated_ray_marching::Solution& last) {
  if (last.empty() || groups_.empty()) return;
  const auto n = std::size_t(count_);
  std::vector<double> vectors(vectors_->bytes() / sizeof(double), 0.0);
  for (Group& g : groups_) {
    std::vector<Eigen::VectorXd> starts;
    for (const int channel : g.channels) starts.push_back(at_centres(last, channel, gaussians_));
    const auto known = [](const Eigen::VectorXd& start) { return start.size() > 0; };
    if (!std::all_of(starts.begin(), starts.end(), known)) continue;
    // One system stands for all channels until their light differs.
    if (std::any_of(starts.begin(), starts.end(), [&](const auto& start) { return start != starts[0]; }))
      g.systems = int(g.channels.size());
    for (std::size_t s = 0; s < starts.size(); ++s)
      std::copy(starts[s].begin(), starts[s].end(),
                vectors.begin() + long(((std::size_t(g.first) + s) * vector_count + solution_vector) * n));
  }
  vectors_->upload(vectors);
}

airlight::compensated_ray_marching::Solution CentreSourcesOnDevice::solution() const {
  airlight::compensated_ray_marching::Solution now;
  if (groups_.empty()) return now;
  const std::vector<double> vectors = vectors_->download<double>();
  now.centres = gaussians_;
  for (const Group& g : groups_)
    for (std::size_t i = 0; i < g.channels.size(); ++i) {
      const std::size_t system = std::size_t(g.first) + (g.systems == 1 ? 0 : i);
      now.of_channel[std::size_t(g.channels[i])] = Eigen::Map<const Eigen::ArrayXd>(
          vectors.data() + (system * vector_count + solution_vector) * std::size_t(count_), count_);
    }
  return now;
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

void CentreSourcesOnDevice::bind_systems(Program& p, const Group& g) const {
  vectors_->bind(at::vectors);
  systems_->bind(at::systems);
  p.set("gaussian_count", count_);
  p.set("first_system", g.first);
}

void CentreSourcesOnDevice::bind_channels(Program& p, const Group& g) const {
  bind_systems(p, g);
  centres_->bind(at::centres);
  single_->bind(at::single_bands);
  for (std::size_t i = 0; i < g.channels.size(); ++i) p.set(at_index("channel", i), g.channels[i]);
}

void CentreSourcesOnDevice::product(const Group& g, bool transposed, int from, int to) {
  Program& p = transposed ? *transposed_program_ : *product_program_;
  bind_systems(p, g);
  g.matrix->bind(at::matrix);
  p.set("from_vector", from);
  p.set("to_vector", to);
  p.dispatch(count_, 1, g.systems);
}

void CentreSourcesOnDevice::gradients(const Group& g, int stage) {
  Program& p = *gradients_program_;
  bind_systems(p, g);
  p.set("stage", stage);
  p.set("most_iterations", options_.iterations);
  p.set_double("tolerance", options_.tolerance);
  p.dispatch(summing, 1, stage == stage_spread ? int(g.channels.size()) : g.systems);
}

void CentreSourcesOnDevice::scatter_again(Group& g, const scene::Execution& execution) {
  const bool printed = options_.paper.multiple == Options::Paper::Multiple::as_printed;
  const int channel = g.channels[0];
  const double sigma_t = medium_.sigma_t[channel], albedo = medium_.albedo[channel];
  const double cosine = mean_cosine(medium_.phase), sigma_tr = (1 - albedo * cosine) * sigma_t;
  Program& of_right = *right_program_;
  bind_channels(of_right, g);
  g.row_scales->bind(at::row_scales);
  of_right.set_double("of_mean", printed ? -sigma_t / albedo : -sigma_t);
  of_right.set_double("of_gradient", sigma_t / ((printed ? 1 : 3) * sigma_tr));
  of_right.dispatch(lanes * count_, 1, g.systems);

  solve(g, execution);

  Program& again = *again_program_;
  bind_channels(again, g);
  again_->bind(at::again);
  again.set("channels", int(g.channels.size()) / g.systems);
  again.set_double("albedo", albedo);
  again.set_double("mean_cosine", cosine);
  again.set_double("sigma_t", sigma_t);
  again.set_double("factor", (printed ? 1 : 3) / (3 * sigma_tr));
  again.dispatch(lanes * count_, 1, g.systems);
}

// Least squares: conjugate gradients of the normal equations, or LSQR.
void CentreSourcesOnDevice::solve(Group& g, const scene::Execution& execution) {
  product(g, false, solution_vector, along);
  gradients(g, stage_residual);
  product(g, true, residual_vector, gradient);
  product(g, true, right, along);
  gradients(g, stage_begin);
  int told = 0, next = std::min(g.last > 0 ? g.last : first_centre_iterations, options_.iterations);
  for (bool done = false; !done;) {
    for (; told < next; ++told) {
      product(g, false, is_lsqr() ? gradient : direction, along);
      gradients(g, stage_step);
      product(g, true, residual_vector, is_lsqr() ? along : gradient);
      gradients(g, stage_turn);
    }
    const std::vector<SystemData> all = systems_->download<SystemData>();
    done = true;
    g.last = 0;
    for (int s = g.first; s < g.first + g.systems; ++s) {
      done = done && all[std::size_t(s)].done != 0;
      g.last = std::max(g.last, all[std::size_t(s)].iterations);
    }
    if (done) {
      for (int s = g.first; s < g.first + g.systems; ++s) {
        const SystemData& system = all[std::size_t(s)];
        const int alike = int(g.channels.size()) / g.systems;
        iterations_ += alike * system.iterations;
        residual_ = std::max(residual_, std::sqrt(system.square) / system.whole);
        negative_share_ += double(alike * system.negative) / (3 * count_);
      }
    } else {
      if (execution.progress && !execution.progress(1)) throw scene::Interrupted("interrupted");
      next = told + std::max(4, told / 2);
    }
  }
}

void CentreSourcesOnDevice::light(const std::vector<Rgb>& light, StageTimer& timer, const scene::Execution& execution) {
  iterations_ = 0;
  residual_ = negative_share_ = 0;
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
  if (groups_.empty()) return;
  timer.begin("multiple scattering");
  for (Group& g : groups_)
    if (!grey && g.systems < int(g.channels.size())) {
      gradients(g, stage_spread);
      g.systems = int(g.channels.size());
    }
  systems_->clear();
  for (Group& g : groups_) scatter_again(g, execution);
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
