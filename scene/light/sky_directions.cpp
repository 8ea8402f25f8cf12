#include "scene/light/sky_directions.h"

#include <algorithm>
#include <cmath>

namespace airlight::scene {

std::vector<DirectionalLight> environment_as_lights(const EnvironmentLight& environment, int count) {
  const double golden = 0.6180339887498949;  // (sqrt 5 - 1) / 2
  std::vector<DirectionalLight> lights;
  for (int k = 0; k < count; ++k) {
    const double u2 = (k + 0.5) * golden;
    const Vec3 w = sample_environment(environment, (k + 0.5) / count, u2 - std::floor(u2));
    const double pdf = pdf_environment(environment, w);
    const Rgb from_there = radiance(environment, w);
    if (!(pdf > 0) || (from_there == 0).all()) continue;
    lights.push_back({w, from_there / (pdf * count)});
  }
  return lights;
}

std::vector<Light> lights_from_directions(const std::vector<Light>& lights, int count, bool swallowed) {
  std::vector<Light> all;
  for (const Light& light : lights) {
    if (swallowed && !ball(light)) continue;
    if (const auto* environment = std::get_if<EnvironmentLight>(&light))
      for (const DirectionalLight& one : environment_as_lights(*environment, count)) all.emplace_back(one);
    else
      all.push_back(light);
  }
  return all;
}

Scene with_sky_as_lights(const Scene& scene, int count) {
  Scene lit = scene;
  for (const Light& light : scene.lights)
    if (const auto* environment = std::get_if<EnvironmentLight>(&light))
      for (const DirectionalLight& one : environment_as_lights(*environment, count)) lit.lights.emplace_back(one);
  return lit;
}

bool swallows_distant_light(const std::vector<Medium>& media) {
  Rgb everywhere = Rgb::Zero();  // extinction that is there in all places [1/m]
  for (const Medium& medium : media) {
    if (!std::holds_alternative<Unbounded>(medium.region)) continue;
    if (const auto* constant = std::get_if<Homogeneous>(&medium.field))
      everywhere += medium.sigma_t * constant->density;
    if (const auto* sum = std::get_if<GaussianSum>(&medium.field)) everywhere += medium.sigma_t * sum->constant;
  }
  return (everywhere > 0).all();
}

}  // namespace airlight::scene
