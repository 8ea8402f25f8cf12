// Smoke of voxels for pictures of the device, and how far these are from the processor's.
#pragma once
#include <Eigen/Geometry>

#include "scene/convert/residual.h"
#include "scene/media/fitted.h"
#include "tests/gpu/device.h"
#include "tests/gpu/p99.h"
#include "tests/methods/compensated_ray_marching/puffs.h"
#include "tests/methods/compensated_ray_marching/rough_sky.h"

namespace airlight::gpu::test {

// Every layer at the worst pixel. Single precision: depths and places are rounded to 6e-8 of the whole, solves go on to 1e-5.
inline void compare(const scene::Film& a, const scene::Film& b, double most = 5e-5) {
  most += 20 * injected_error();
  agree("smoke", a, b, {most, most});
}

// Smoke seen from the front, on a film that is no multiple of a tile.
inline std::shared_ptr<scene::Scene> scene_13_wide(scene::DensityField field, double sigma_t, double albedo,
                                                   scene::EnvironmentLight light) {
  auto scene = airlight::test::scene_of(std::move(field), sigma_t, albedo, std::move(light));
  scene->width = 13;
  finish(*scene);
  return scene;
}

// Beside a centre of the puffs, in it, wide, from far above, and parallel.
inline std::vector<scene::Camera> cameras_about_puffs() {
  std::vector<scene::Camera> all{
      scene::look_at({0.05, 0.1, 0}, {1, 0.1, 0}, Vec3::UnitY()), scene::look_at({0, 0, 0}, {1, 0.1, 0}, Vec3::UnitY()),
      scene::look_at({0.05, 0.1, 0.6}, {0, 0, 0}, Vec3::UnitY()), scene::look_at({0, 40, 0}, {0, 0, 0}, Vec3::UnitZ())};
  all[2].vertical_fov = 2.9;
  all[3].vertical_fov = 0.05;
  all.push_back(all[3]);
  all.back().kind = scene::Camera::Kind::orthographic;
  all.back().height = 2;
  return all;
}

// 9 x 7 x 8 voxels of density 0 to 1.4 in no order, from a corner on, turned about a slanting axis.
inline std::shared_ptr<scene::VoxelGrid> uneven_voxels(const Vec3& corner, double turn = 0.5) {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {9, 7, 8};
  grid->voxel_size = 0.2;
  grid->rotation = Eigen::AngleAxisd(turn, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  grid->translation = corner;
  for (int i = 0; i < 9 * 7 * 8; ++i) grid->values.push_back(float(std::max(0.0, 0.4 + std::sin(0.37 * i))));
  return grid;
}

inline scene::FittedPointer fitted_with_residual(const scene::VoxelGrid& grid) {
  auto fitted = std::make_shared<scene::Fitted>();
  fitted->gaussians = airlight::test::puffs();
  fitted->residual = std::make_shared<const scene::Residual>(scene::residual_of(grid, fitted->gaussians, {0, {}}));
  fitted->grid = grid;
  return fitted;
}

// A picture behind and within the smoke: depths in no order, every third without end.
inline std::shared_ptr<const scene::Backdrop> backdrop_with_depths(int width, int height) {
  scene::Backdrop backdrop{width, height, {}, {}, true};
  for (int i = 0; i < width * height; ++i) {
    for (int c = 0; c < 3; ++c) backdrop.radiance.push_back(float(0.1 + 0.001 * i + 0.1 * c));
    backdrop.depth.push_back(float(i % 3 ? 2.5 + 0.01 * i : infinity));
  }
  return std::make_shared<const scene::Backdrop>(backdrop);
}

}  // namespace airlight::gpu::test
