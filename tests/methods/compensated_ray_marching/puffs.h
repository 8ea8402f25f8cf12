// Three Gaussians that overlap, and any smoke seen from the front.
#pragma once
#include "tests/methods/compensated_ray_marching/risen.h"
#include "tests/pictures.h"

namespace airlight::test {

inline scene::GaussianSum puffs() {
  scene::GaussianSum sum;
  sum.cutoff = 3;
  sum.gaussians = {{{0, 0, 0}, 0.4, 1}, {{0.5, 0.2, -0.1}, 0.25, 0.7}, {{-0.3, 0.4, 0.2}, 0.3, 0.9}};
  return sum;
}

inline std::shared_ptr<scene::Scene> scene_of(scene::DensityField field, double sigma_t, double albedo,
                                              scene::EnvironmentLight light) {
  auto s = std::make_shared<scene::Scene>();
  s->camera = scene::look_at({0.3, 0.5, 4}, {0, 0.1, 0}, Vec3::UnitY());
  s->camera.vertical_fov = 0.6;
  s->width = 12;
  s->height = 9;
  s->lights = {std::move(light)};
  scene::Medium smoke;
  smoke.field = std::move(field);
  smoke.sigma_t = Rgb::Constant(sigma_t);
  smoke.albedo = Rgb::Constant(albedo);
  s->media = {smoke};
  finish(*s);
  return s;
}
inline std::shared_ptr<scene::Scene> in_white(scene::GaussianSum sum, double sigma_t, double albedo = 0.8) {
  return scene_of(std::move(sum), sigma_t, albedo, scene::make_constant_environment(Rgb::Ones()));
}

}  // namespace airlight::test
