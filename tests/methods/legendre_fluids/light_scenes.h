// Densities and scenes for tests of light in Legendre boxes.
#pragma once
#include <random>

#include "scene/math/legendre_range.h"
#include "scene/scene.h"
#include "tests/pictures.h"

namespace airlight::legendre_fluids::testing {

inline const Box unit_box{Point3::Constant(-1), Point3::Constant(1)};

// Mean 1, between 0.4 and 1.6, from random coefficients that fall with (1 + i + j + k)^-decay.
inline scene::LegendrePointer random_density(const scene::TensorShape& n, unsigned seed, double decay = 1,
                                             const Box& box = unit_box) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd c(scene::tensor_size(n));
  Eigen::Index at = 0;
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k) c[at++] = normal(random) * std::pow(1.0 + i + j + k, -decay);
  c[0] = 0;
  if (c.size() > 1) {
    const auto enough = [](const scene::GreatestValue& v) { return v.bound - v.found <= 0.01 * v.found; };
    c *= 0.6 / std::max(scene::legendre_greatest(c, n, enough).bound, scene::legendre_greatest(-c, n, enough).bound);
  }
  c[0] = std::sqrt(8.0);
  return std::make_shared<const scene::LegendreBox>(box, n, c);
}

inline scene::Medium smoke(scene::LegendrePointer field, double sigma_t, double albedo = 0.8) {
  scene::Medium medium;
  medium.field = std::move(field);
  medium.sigma_t = Rgb::Constant(sigma_t);
  medium.albedo = Rgb::Constant(albedo);
  return medium;
}

// Two densities that differ in albedo alone, beside each other in all channels: a medium whose albedo is a field.
inline std::shared_ptr<scene::Scene> with_albedo_field(std::shared_ptr<scene::Scene> scene, const scene::TensorShape& n,
                                                       unsigned seed) {
  scene::Medium other = scene->media[0];
  other.field = random_density(n, seed);
  scene->media[0].albedo = {1, 0.6, 0};
  other.albedo = {0, 0.6, 1};
  scene->media.push_back(other);
  finish(*scene);
  return scene;
}

// Light travels along (.48, .6, -.64), what is seen along (-.36, .48, .8): the directions of the specification's table.
inline const Vec3 oblique_light(-0.48, -0.6, 0.64), oblique_view(0.36, -0.48, -0.8);

inline std::shared_ptr<scene::Scene> lit_scene(const scene::Medium& medium, const Vec3& to_light, const Vec3& view,
                                               int width, int height, double film_height = 2.6) {
  auto scene = std::make_shared<scene::Scene>();
  scene->media = {medium};
  scene->lights = {scene::DirectionalLight{to_light.normalized(), Rgb::Ones()}};
  scene->camera = scene::look_at(-5 * view, Point3::Zero(), std::abs(view[1]) > 0.9 ? Vec3::UnitZ() : Vec3::UnitY());
  scene->camera.kind = scene::Camera::Kind::orthographic;
  scene->camera.height = film_height;
  scene->width = width;
  scene->height = height;
  finish(*scene);
  return scene;
}

}  // namespace airlight::legendre_fluids::testing
