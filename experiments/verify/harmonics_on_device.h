// Harmonics of the shaders of the centres (Zhou et al. 2008, variant `paper`), for vectors.
#pragma once
#include <vector>

#include "experiments/verify/check.h"
#include "experiments/verify/smoke_vector.h"
#include "gpu/compensated_ray_marching/centre_sources.h"
#include "gpu/shader_source.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::experiments::verification {

namespace crm = compensated_ray_marching;
namespace on = gpu::compensated_ray_marching;

// A step of passed.glsl on the device, in double precision: passed_steps.comp, which says what is given.
enum class Step { product, about_axis, passed, angle, terms };
inline std::vector<double> step_on_device(Step step, int order, const std::vector<double>& given,
                                          crm::Transmittance kind = crm::Transmittance::series,
                                          const scene::GaussianSum& smoke = {}) {
  gpu::Context& context = gpu::Context::get();
  const on::CentreTables tables(context, order, kind, smoke.cutoff, step == Step::angle);
  const gpu::Buffer centres(context, "centres", numbers_of(smoke.gaussians)), nothing(context, "no spheres", 4),
      in(context, "given", given), result(context, "result", 16 * std::size_t(order * order));
  gpu::Program& program = on::program(context, "passed_steps", 64, 1, tables.definitions());
  tables.bind(program);
  tables.bind_terms();
  centres.bind(on::at::centres);
  nothing.bind(on::at::spheres);
  in.bind(on::at::passed);
  result.bind(on::at::result);
  program.set("gaussian_count", int(smoke.gaussians.size()));
  program.set("sphere_count", 0);
  program.set("step_", int(step));
  program.dispatch(64);
  std::vector<double> values = result.download<double>();
  if (step == Step::angle || step == Step::terms) values.resize(1);
  if (step == Step::product || step == Step::about_axis) values.resize(std::size_t(order * order));
  return values;
}
// Transmittance to the origin for one extinction, and minus the depth around it.
struct Passed {
  crm::Harmonics passed, minus_depth;
};
inline Passed passed_on_device(int order, crm::Transmittance kind, const scene::GaussianSum& smoke, double sigma_t) {
  const std::vector<double> all = step_on_device(Step::passed, order, {0, 0, 0, sigma_t}, kind, smoke);
  Passed result{{all.begin(), all.begin() + order * order}, {all.begin() + order * order, all.end()}};
  for (double& value : result.minus_depth) value *= sigma_t;
  return result;
}

// Compares the light that the device scatters into directions, from an undimmed light, with convolved light in
// propagation directions, as a root mean square.
inline Outcome compare_scattered(int order, double g, const crm::Harmonics& light, const crm::Harmonics& convolved) {
  gpu::Context& context = gpu::Context::get();
  scene::Medium medium;
  scene::GaussianSum sum;
  sum.cutoff = 3;
  sum.gaussians = {{Point3::Zero(), 1, 1}};
  medium.field = sum;
  medium.sigma_t = Rgb::Constant(1e-12);
  medium.albedo = Rgb::Ones();
  medium.phase = scene::HenyeyGreenstein{g};
  gpu::StageTimer timer(context);
  on::CentreSourcesOnDevice centres(context, sum, medium, {}, true, nullptr, {}, paper_options(order), timer, {1, {}});
  std::vector<Rgb> bands;
  for (const double b : crm::turned_back(light)) bands.push_back(Rgb::Constant(b));
  centres.light(bands, timer, {1, {}});
  double squares = 0, off = 0;
  for (const crm::Ordinate& d : crm::ordinate_directions(order, 2 * order, false)) {
    const std::vector<double> y = scene::evaluate_sh(order, d.direction);
    double expected = 0;
    for (std::size_t i = 0; i < y.size(); ++i) expected += convolved[i] * y[i] / (4 * pi);
    scene::View view{scene::look_at(d.direction, Point3::Zero(), Vec3(0.3, 0.5, -0.7)), 1, 1};
    view.camera.kind = scene::Camera::Kind::orthographic;
    centres.towards(view);
    const double got = centres.sources().download<std::array<float, 4>>().at(0)[0];
    squares += d.weight * expected * expected;
    off += d.weight * std::pow(got - expected, 2);
  }
  return {{absolute("off the convolution", 0, std::sqrt(off / squares), 1e-6 + gpu::injected_error())}};
}

}  // namespace airlight::experiments::verification
