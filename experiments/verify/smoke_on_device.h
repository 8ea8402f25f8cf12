// Zhou et al. 2008 on the device, for vectors: scenes for pictures of one ray, and source radiance at the nodes of `variant = grid`.
#pragma once
#include <memory>
#include <vector>

#include "experiments/verify/check.h"
#include "experiments/verify/one_ray.h"
#include "gpu/compensated_ray_marching/compensated_ray_marching.h"
#include "gpu/compensated_ray_marching/lit_grid.h"
#include "gpu/shader_source.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"

namespace airlight::experiments::verification {

namespace crm = compensated_ray_marching;
namespace on = gpu::compensated_ray_marching;

inline const crm::CompensatedRayMarching processor_renderer;
inline const on::CompensatedRayMarching device_renderer;
constexpr double parity = 1e-4;  // of device and processor, relative

// Grey smoke under harmonics of lookup directions, by default a radiance of 1 from everywhere; a film of one pixel.
inline std::shared_ptr<scene::Scene> smoke_scene(const scene::GaussianSum& smoke, double sigma_t, double albedo = 0,
                                                 double g = 0,
                                                 const std::vector<Rgb>& light = {Rgb::Constant(std::sqrt(4 * pi))}) {
  auto s = std::make_shared<scene::Scene>();
  scene::Medium medium;
  medium.field = smoke;
  medium.sigma_t = Rgb::Constant(sigma_t);
  medium.albedo = Rgb::Constant(albedo);
  medium.phase = scene::HenyeyGreenstein{g};
  s->media = {medium};
  s->lights = {scene::make_sh_environment(light, Mat3::Identity(), Rgb::Ones())};
  s->width = s->height = 1;
  finish(*s);
  return s;
}

// Source radiance at the nodes of a grid of cubes, on both. The scene gets a Gaussian that is as good as nothing, which makes x the middle
// node, where `half_side` is above 0.
struct AtNodes {
  AtNodes(const scene::Scene& s, const Given& given, const Point3& x = Point3::Zero(), double half_side = 0)
      : lit(centred(s, x, half_side)),
        options(crm::read_options({processor_renderer.settings(), given})),
        light(lit.lights, crm::EnvironmentBands(options.grid.levels)),
        grid(lit, lit.media[0], options, light, {1, {}}),
        field(lit.media[0], options),
        density(context, field, Point3::Zero(), false),
        columns(context, lit, grid, density, Point3::Zero()),
        source(context, lit.media[0], options, grid, columns) {
    gpu::StageTimer timer(context);
    timer.begin("light");
    grid.light(light, {1, {}});
    source.light(light, timer, {1, {}});
    timer.times();
  }
  std::vector<std::array<float, 4>> towards(const scene::Camera& camera) {
    source.towards({camera, 1, 1}, Point3::Zero());
    return source.logarithms().download<std::array<float, 4>>();
  }
  // The greatest difference of logarithms of the two, of nodes that are not below 1e-3 of the brightest.
  Comparison difference(const std::string& what, const scene::Camera& camera) {
    const std::vector<Rgb> truth = grid.towards(camera, {1, {}});
    const std::vector<std::array<float, 4>> got = towards(camera);
    double most = -infinity, worst = 0;
    for (const Rgb& t : truth) most = std::max(most, t.maxCoeff());
    for (std::size_t i = 0; i < truth.size(); ++i)
      for (int c = 0; c < 3; ++c)
        if (truth[i][c] > most + std::log(1e-3) && !(std::abs(got[i][std::size_t(c)] - truth[i][c]) <= worst))
          worst = std::abs(double(got[i][std::size_t(c)]) - truth[i][c]);
    return absolute(what + ", nodes as the processor's", 0, worst, parity);
  }
  // A node is found by its place among the nodes, counted from the middle one.
  double at(const std::vector<std::array<float, 4>>& values, const Eigen::Vector3i& place) const {
    const auto& n = grid.grid().cells.size;
    const Eigen::Vector3i p = place + Eigen::Vector3i(n[0], n[1], n[2]) / 2;
    return std::exp(double(values.at(std::size_t(p[0] + n[0] * (p[1] + n[1] * p[2])))[0]));
  }

  static scene::Scene centred(scene::Scene s, const Point3& x, double half_side) {
    if (half_side > 0) std::get<scene::GaussianSum>(s.media[0].field).gaussians.push_back({x, half_side / 3, 1e-12});
    finish(s);
    return s;
  }

  gpu::Context& context = gpu::Context::get();
  scene::Scene lit;
  crm::Options options;
  crm::IncomingLight light;
  crm::LitGrid grid;
  crm::SmokeField field;
  on::SmokeDensity density;
  on::SmokeColumns columns;
  on::LitGridOnDevice source;
};

}  // namespace airlight::experiments::verification
