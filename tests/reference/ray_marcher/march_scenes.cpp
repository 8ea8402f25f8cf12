#include "tests/reference/ray_marcher/march_scenes.h"

#include <Eigen/Geometry>
#include <cmath>

namespace airlight::ray_marcher {
namespace {

scene::Light point(const Point3& at, double intensity = 3) {
  return scene::PointLight{at, Rgb(intensity, 0.8 * intensity, 0.5 * intensity), 0};
}
scene::Light sun(const Vec3& to, double irradiance = 2) {
  return scene::DirectionalLight{to.normalized(), Rgb(irradiance, 0.9 * irradiance, 0.7 * irradiance)};
}
scene::Light spot(const Point3& at, const Vec3& axis) {
  scene::SpotLight light;
  light.position = at;
  light.axis = axis.normalized();
  light.inner_angle = 0.2;
  light.outer_angle = 0.5;
  light.intensity = Rgb(4, 5, 6);
  return light;
}

scene::GaussianSum blobs(double constant) {
  scene::GaussianSum sum;
  sum.constant = constant;
  sum.gaussians = {
      {Point3(0.1, 0.2, 0), 0.3, 2.0}, {Point3(-0.4, 0, 0.3), 0.15, 4.0}, {Point3(0.5, -0.3, -0.2), 0.5, 0.7}};
  return sum;
}

}  // namespace

std::shared_ptr<const scene::VoxelGrid> make_smoke(int size, double voxel, const Vec3& corner, const Mat3& rotation,
                                                   bool clamp_border) {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size.setConstant(size);
  grid->origin_index = Eigen::Vector3i(3, -2, 7);
  grid->rotation = rotation;
  grid->voxel_size = voxel;
  grid->translation = corner - rotation * (voxel * grid->origin_index.cast<double>());
  grid->clamp_border = clamp_border;
  for (int k = 0; k < size; ++k)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const Vec3 p = Vec3(i, j, k) / (size - 1.0) - Vec3::Constant(0.5);
        const double value = 1 - 8 * p.squaredNorm() + 0.3 * std::sin(17 * p[0]) * std::cos(23 * p[1] + 5 * p[2]);
        grid->values.push_back(float(std::max(0.0, value)));
      }
  return grid;
}

std::vector<std::pair<std::string, std::shared_ptr<const scene::Scene>>> assorted_scenes() {
  const Rgb grey = Rgb::Constant(2), red(1, 2, 4), white = Rgb::Constant(0.9), tinted(0.9, 0.7, 0.5);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto straight = make_smoke(20, 0.1, Vec3(-0.95, -0.95, -0.95), Mat3::Identity());
  const auto turned = make_smoke(16, 0.125, turn * Vec3(-0.95, -0.95, -0.95), turn);
  const auto bordered = make_smoke(16, 0.09375, Vec3(-0.7, -0.7, -0.7), Mat3::Identity(), true);
  std::vector<std::pair<std::string, std::shared_ptr<const scene::Scene>>> all;
  const auto add = [&](const char* name, std::vector<scene::Medium> media, std::vector<scene::Light> lights) {
    all.emplace_back(name, make_scene(std::move(media), std::move(lights)));
  };
  add("nothing", {}, {point(Point3(1, 1, 1))});
  add("homogeneous sphere", {make_medium(scene::Homogeneous{0.7}, scene::Sphere{Point3(0.1, 0, 0), 0.8}, grey, white)},
      {point(Point3(0.3, 0.5, 0.2)), sun(Vec3(1, 2, 0.5))});
  add("unbounded fog", {make_medium(scene::Homogeneous{0.2}, scene::Unbounded{}, red, tinted, scene::Rayleigh{})},
      {point(Point3(0.3, 0.5, 0.2)), spot(Point3(-1, 1, 0), Vec3(1, -1, 0))});
  scene::Slab slab;
  slab.normal = Vec3(0.1, 1, 0.2).normalized();
  slab.lo = -0.4;
  slab.hi = 0.5;
  add("slab and box",
      {make_medium(scene::Homogeneous{0.5}, slab, grey, white, scene::Hazy{}),
       make_medium(scene::Homogeneous{0.5}, Box{Point3(-0.5, -0.6, -0.7), Point3(0.6, 0.7, 0.5)}, red, tinted)},
      {sun(Vec3(0.3, 1, 0.2))});
  add("Gaussians", {make_medium(blobs(0), scene::Unbounded{}, grey, white, scene::HenyeyGreenstein{0.7})},
      {point(Point3(0.3, 0.5, 0.2)), sun(Vec3(-1, 0.5, 1))});
  scene::GaussianSum carved = blobs(0.3);
  carved.gaussians[1].amplitude = -3;
  carved.cutoff = 2.5;
  add("Gaussians with a hole, cut off, over a constant, in a sphere",
      {make_medium(carved, scene::Sphere{Point3::Zero(), 1}, red, tinted, scene::Murky{})},
      {point(Point3(0.3, 0.5, 2))});
  add("grid", {make_medium(straight, scene::Unbounded{}, 3 * grey, white, scene::HenyeyGreenstein{-0.4})},
      {point(Point3(0.3, 0.5, 0.2)), sun(Vec3(1, 1, 1))});
  add("turned grid in a box",
      {make_medium(turned, Box{Point3(-0.5, -0.6, -0.7), Point3(0.6, 0.7, 0.5)}, 3 * red, white)},
      {sun(Vec3(1, 1, -1)), spot(Point3(0, 1.5, 0.5), Vec3(0, -1, -0.2))});
  add("overlap of all",
      {make_medium(straight, scene::Unbounded{}, grey, white),
       make_medium(bordered, scene::Unbounded{}, grey, tinted, scene::Rayleigh{}),
       make_medium(blobs(0.1), scene::Unbounded{}, red, tinted, scene::HenyeyGreenstein{0.95}),
       make_medium(scene::Homogeneous{0.3}, scene::Sphere{Point3(0.1, 0, 0), 0.8}, grey, white)},
      {point(Point3(0.3, 0.5, 0.2)), sun(Vec3(1, 1, 1))});
  add("grid under the sky", {make_medium(straight, scene::Unbounded{}, 3 * red, white, scene::HenyeyGreenstein{0.5})},
      {scene::make_constant_environment(Rgb(0.5, 0.7, 1)), sun(Vec3(1, 1, 1))});
  auto furnished = std::make_shared<scene::Scene>(*all[8].second);
  furnished->surfaces = {{"ball", scene::Sphere{Point3(0.2, -0.1, 0.1), 0.35}, scene::Lambert{Rgb(0.8, 0.5, 0.3)}},
                         {"floor", scene::Plane{Point3(0, -0.8, 0), Vec3::UnitY()}, scene::Phong{}}};
  furnished->lights.push_back(scene::make_constant_environment(Rgb(0.5, 0.7, 1)));
  finish(*furnished);
  all.emplace_back("overlap with surfaces under the sky", furnished);
  return all;
}

std::shared_ptr<const scene::Scene> scaled_scene(const scene::Scene& original, double scale) {
  scene::Scene scene = original;
  for (scene::Medium& medium : scene.media) {
    medium.sigma_t /= scale;
    if (auto* box = std::get_if<Box>(&medium.region)) *box = {box->lo * scale, box->hi * scale};
    if (auto* sphere = std::get_if<scene::Sphere>(&medium.region))
      *sphere = {sphere->center * scale, sphere->radius * scale};
    if (auto* slab = std::get_if<scene::Slab>(&medium.region)) slab->lo *= scale, slab->hi *= scale;
    if (auto* sum = std::get_if<scene::GaussianSum>(&medium.field))
      for (scene::Gaussian& g : sum->gaussians) g.center *= scale, g.width *= scale;
    if (auto* grid = std::get_if<std::shared_ptr<const scene::VoxelGrid>>(&medium.field)) {
      auto copy = std::make_shared<scene::VoxelGrid>(**grid);
      copy->voxel_size *= scale;
      copy->translation *= scale;
      *grid = copy;
    }
  }
  for (scene::Light& light : scene.lights) {
    if (auto* point = std::get_if<scene::PointLight>(&light)) {
      point->position *= scale;
      point->intensity *= scale * scale;
    }
    if (auto* spot = std::get_if<scene::SpotLight>(&light)) {
      spot->position *= scale;
      spot->intensity *= scale * scale;
    }
  }
  finish(scene);
  return std::make_shared<scene::Scene>(std::move(scene));
}

}  // namespace airlight::ray_marcher
