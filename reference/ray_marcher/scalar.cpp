#include "reference/ray_marcher/scalar.h"

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/depth.h"
#include "scene/light/background.h"

namespace airlight::ray_marcher {
namespace {

// (1 - exp(-x)) / x, 1 at x = 0.
double mean_over_step(double x) { return x > 0 ? -std::expm1(-x) / x : 1; }

// Densities of all layers at a step.
void sample_densities(const Plan& plan, const Ray& ray, const Step& step, std::vector<double>& densities,
                      Counters& counters) {
  const Point3 x = ray.at(step.t);
  for (std::size_t k = 0; k < plan.layers.size(); ++k) {
    double value = in_constant(step.inside, k) ? plan.layers[k].constant : 0;
    if (in_varied(step.inside, k)) {
      value += varied_density(plan.layers[k], x);
      ++counters.steps;
    }
    densities[k] = value;
  }
}

// In-scattered radiance per length at x towards -direction [W/m^3/sr], for light that comes as `from`.
Rgb in_scattered(const Plan& plan, std::size_t light, const std::vector<double>& densities, const Point3& x,
                 const Vec3& direction, const scene::Incident& from, Counters& counters) {
  if ((from.irradiance == 0).all()) return Rgb::Zero();
  const double cosine = std::clamp(from.to_light.dot(direction), -1.0, 1.0);
  Rgb scattering = Rgb::Zero();
  for (std::size_t k = 0; k < plan.layers.size(); ++k) {
    if (densities[k] == 0) continue;
    const scene::Medium& medium = *plan.layers[k].medium;
    scattering += medium.albedo * medium.sigma_t * (densities[k] * phase_value(medium.phase, cosine));
  }
  if ((scattering == 0).all()) return Rgb::Zero();
  return scattering * from.irradiance * transmittance_to_light(plan, light, x, from, counters);
}

// Light that a lamp sends to a step: evaluated at the midpoint, but with the mean of the inverse square over the step.
scene::Incident incident_on_step(const scene::Light& light, const Ray& ray, const Step& step) {
  const auto ball = scene::ball(light);
  if (!ball) return incident(light, ray.at(step.t));
  const Vec3 offset = ball->center - ray.at(step.t);
  const double distance = offset.norm();
  const Vec3 to_light = distance > 0 ? Vec3(offset / distance) : Vec3(-ray.direction);
  return {to_light, distance,
          intensity_towards(light, -to_light) * mean_inverse_square(approach(ray, ball->center), step)};
}

// Divides deep steps; the passes remain.
void divide_deep_steps(const Plan& plan, const Ray& ray, std::vector<Pass>& passes, std::vector<Step>& steps) {
  if (std::none_of(steps.begin(), steps.end(),
                   [&](const Step& step) { return may_be_deep(plan.layers, plan.options, step); }))
    return;
  std::vector<Step> divided;
  for (Pass& pass : passes) {
    const std::size_t begin = divided.size();
    follow_depth(plan, ray, pass.spacing.deepest, steps.data() + pass.spacing.begin, steps.data() + pass.spacing.end,
                 divided);
    pass.spacing.begin = begin;
    pass.spacing.end = divided.size();
  }
  steps.swap(divided);
}

}  // namespace

Rgb transmittance_to_light(const Plan& plan, std::size_t light, const Point3& x, const scene::Incident& from,
                           Counters& counters) {
  const Ray ray{x, from.to_light};
  if (plan.scene->geometry) {
    ++counters.occlusion_rays;
    if (plan.scene->geometry->occluded(ray, from.distance)) return Rgb::Zero();
  }
  if (!plan.maps.empty()) {
    ++counters.look_ups;
    return (-plan.maps[light]->optical_depth(x)).exp();
  }
  Rgb depth = Rgb::Zero();
  ++counters.shadow_rays;
  for (const Layer& layer : plan.layers) {
    const double column = plan.options.shadow == Shadow::exact
                              ? density_integral(*layer.medium, ray, {0, from.distance})
                              : marched_column(layer, plan.options, ray, {0, from.distance}, counters.shadow_steps);
    // An infinite column must not meet a zero coefficient.
    for (int c = 0; c < 3; ++c)
      if (layer.medium->sigma_t[c] > 0) depth[c] += layer.medium->sigma_t[c] * column;
  }
  return (-depth).exp();
}

Rgb lit_surface(const Plan& plan, const scene::Hit& hit, const Vec3& direction, Counters& counters) {
  Rgb sum = Rgb::Zero();
  const scene::Material& material = plan.scene->surfaces[hit.surface].material;
  for (std::size_t l = 0; l < plan.lights.size(); ++l) {
    const scene::Incident from = incident(plan.lights[l], hit.position);
    const double cosine = from.to_light.dot(hit.normal);
    if (!(cosine > 0) || (from.irradiance == 0).all()) continue;
    const Rgb reflected = brdf(material, hit.normal, from.to_light, -direction) * cosine * from.irradiance;
    if ((reflected == 0).all()) continue;
    const Point3 origin = plan.scene->geometry->offset_origin(hit.position, hit.normal, from.to_light);
    sum += reflected * transmittance_to_light(plan, l, origin, from, counters);
  }
  return sum;
}

Pixel march_media(const Plan& plan, const Ray& ray, double t_end, Counters& counters) {
  Pixel pixel;
  std::vector<Step> steps;
  std::vector<Pass> passes;
  add_passes(plan, 0, ray, t_end, passes, steps);
  divide_deep_steps(plan, ray, passes, steps);
  std::vector<double> densities(plan.layers.size());
  for (std::size_t p = 0; p < passes.size(); ++p) {
    const Spacing& spacing = passes[p].spacing;
    Rgb depth = Rgb::Zero();
    bool ended = false;
    for (std::size_t i = spacing.begin; i < spacing.end; ++i) {
      const Step& step = steps[i];
      const Rgb before = (-depth).exp();
      ended = (before < plan.options.early_exit).all();
      if (ended) break;
      sample_densities(plan, ray, step, densities, counters);
      Rgb extinction = Rgb::Zero();
      for (std::size_t k = 0; k < plan.layers.size(); ++k) extinction += plan.layers[k].medium->sigma_t * densities[k];
      if ((extinction == 0).all()) continue;
      const Rgb depth_of_step = extinction * step.length;
      const Rgb weight = before * step.length * depth_of_step.unaryExpr(&mean_over_step);
      const Point3 x = ray.at(step.t);
      for (int light = 0; plan.scatters && light < int(plan.lights.size()); ++light)
        if (serves(passes, p, light))
          pixel.airlight += weight * in_scattered(plan, light, densities, x, ray.direction,
                                                  incident_on_step(plan.lights[light], ray, step), counters);
      depth += depth_of_step;
    }
    if (passes[p].own_light < 0)
      for (int c = 0; c < 3; ++c) pixel.transmittance[c] = spacing.endless[c] || ended ? 0 : std::exp(-depth[c]);
  }
  return pixel;
}

Pixel march_ray(const Plan& plan, const Ray& ray, Counters& counters) {
  ++counters.rays;
  const scene::RayEnd end = camera_end(*plan.scene, ray);
  Pixel pixel = march_media(plan, ray, end.t, counters);
  if ((pixel.transmittance == 0).all()) return pixel;
  if (end.hit)
    pixel.surface = pixel.transmittance * lit_surface(plan, *end.hit, ray.direction, counters);
  else
    pixel.surface = pixel.transmittance * background(*plan.scene, end, ray.direction);
  return pixel;
}

}  // namespace airlight::ray_marcher
