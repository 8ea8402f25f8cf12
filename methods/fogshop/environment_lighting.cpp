#include "methods/fogshop/environment_lighting.h"

#include <cmath>

#include "methods/fogshop/average_depths.h"
#include "scene/light/background.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::fogshop {

EnvironmentLighting::EnvironmentLighting(const scene::Scene& scene, const Options& options, bool spreads,
                                         const EnvironmentLighting* before)
    : order_(options.sh_order), light_(order_ * order_, Rgb::Zero()) {
  for (const scene::Light& light : scene.lights)
    if (const auto* environment = std::get_if<scene::EnvironmentLight>(&light)) {
      const std::vector<Rgb> one = project_environment(*environment, order_);
      for (std::size_t i = 0; i < one.size(); ++i) light_[i] += one[i];
    }
  if (spreads)
    bands_ =
        before && before->bands_ ? before->bands_ : std::make_shared<const PsfBands>(options.environment_psf, order_);
}

std::vector<Rgb> EnvironmentLighting::spread(const Fog& fog, double depth) const {
  std::vector<Rgb> factors(order_);
  for (int c = 0; c < 3; ++c) {
    const double T = depth * fog.extinction_ratio[c];
    const std::vector<double> g = (*bands_)(T);
    for (int l = 0; l < order_; ++l)
      factors[l][c] = std::sqrt(4 * pi / (2 * l + 1)) * g[l] * T * std::exp(-T) * fog.albedo[c];
  }
  return factors;
}

Rgb EnvironmentLighting::airlight(const Fog& fog, double depth, const Vec3& direction) const {
  const std::vector<Rgb> factors = spread(fog, depth);
  const std::vector<double> y = scene::evaluate_sh(order_, direction);
  Rgb sum = Rgb::Zero();
  for (int l = 0; l < order_; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum += factors[l] * light_[i] * y[i];
  return sum.max(0.0);
}

IncidentHarmonics EnvironmentLighting::incident(const Fog& fog, double depth, bool scattered) const {
  IncidentHarmonics result;
  const Rgb arriving = (-depth * fog.extinction_ratio).exp();
  for (const Rgb& light : light_) result.attenuated.push_back(arriving * light);
  if (!scattered) return result;
  const std::vector<Rgb> factors = spread(fog, depth);
  for (int l = 0; l < order_; ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) result.scattered.push_back(factors[l] * light_[i]);
  return result;
}

double average_depth(const Model& model, const Point3& point, const DepthTree* tree) {
  const double constant = model.fog.sum.constant;
  const double sum = tree ? (*tree)(point) : average_depth_of(model.gaussians, point);
  return constant > 0 ? sum + constant * model.options.environment_distance : sum;
}

std::vector<double> up_to_environment(const Options& options, std::vector<double> distance) {
  for (double& d : distance)
    if (d == infinity) d = options.environment_distance;
  return distance;
}

void environment_pass(const scene::Scene& scene, const Model& model, const EnvironmentLighting* lighting,
                      const scene::View& view, const std::vector<double>& distance, const std::vector<double>& depth,
                      const scene::Execution& execution, std::vector<float>& airlight, std::vector<float>& surface) {
  scene::parallel_for(view.height, execution, [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t(y) * view.width + x;
      const bool open = distance[i] == infinity;
      if (!open && !(lighting && model.options.everywhere())) continue;
      const Vec3 direction = camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height).direction;
      const Rgb seen = (-depth[i] * model.fog.extinction_ratio).exp() * background(scene, direction);
      const Rgb scattered = lighting ? lighting->airlight(model.fog, depth[i], direction) : Rgb(Rgb::Zero());
      for (int c = 0; c < 3; ++c) {
        airlight[3 * i + c] += float(scattered[c]);
        if (open) surface[3 * i + c] = float(seen[c]);
      }
    }
  });
}

}  // namespace airlight::fogshop
