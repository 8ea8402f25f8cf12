#include "gpu/compensated_ray_marching/smoke_volume.h"

#include <algorithm>
#include <cmath>

#include "gpu/compensated_ray_marching/gaussian_data.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using compensated_ray_marching::ResidualOnDevice;

constexpr int voxels_of_group = 4;       // along each side of a block
constexpr double nothing_in_voxels = 6;  // widths: methods/compensated_ray_marching/smoke_volume.cpp

}  // namespace

SmokeVolume::SmokeVolume(Context& context, const airlight::compensated_ray_marching::SmokeField& smoke)
    : smoke_(smoke) {
  const scene::VoxelGrid& grid = *smoke.voxels();
  std::vector<GaussianData> data;
  const auto add = [&](const std::vector<scene::Gaussian>& gaussians) {
    for (const scene::Gaussian& g : gaussians)
      data.push_back(gaussian_data(world_to_sample(grid, g.center), g.width / grid.voxel_size, g.amplitude));
  };
  add(smoke.centres().gaussians);
  add(smoke.beyond());
  count_ = int(data.size());
  gaussians_ = std::make_unique<Buffer>(context, "gaussians in voxels", data);
  values_ = std::make_unique<Buffer>(context, "density and source at voxels", 16 * std::size_t(grid.size.prod()));
  Definitions definitions{{"RESIDUAL", "0"}, {"LOCAL_SIZE_Z", std::to_string(voxels_of_group)}};
  if (const airlight::compensated_ray_marching::StoredResidual* residual = smoke.residual()) {
    if (const scene::PerfectHash* hash = residual->hash())
      residual_ =
          std::make_unique<ResidualOnDevice>(context, residual->size(), *hash, ResidualOnDevice::Membership::domain);
    else if (const scene::ApronBricks* bricks = residual->bricks())
      residual_ = std::make_unique<ResidualOnDevice>(context, residual->size(), *bricks);
    else
      residual_ = std::make_unique<ResidualOnDevice>(context, residual->size(), residual->levels());
    for (const auto& [name, value] : residual_->definitions()) definitions[name] = value;
    definitions["RESIDUAL"] = "1";
  }
  program_ = &program(context, "smoke_volume", voxels_of_group, voxels_of_group, definitions);
}

void SmokeVolume::find(const Buffer& sources) const {
  Program& p = *program_;
  const scene::VoxelGrid& grid = *smoke_.voxels();
  gaussians_->bind(at::density);
  sources.bind(at::centre_sources);
  values_->bind(at::volume);
  if (residual_) {
    residual_->bind(p);
    p.set("residual_step", smoke_.residual()->step());
  }
  p.set("gaussian_count", count_);
  p.set("source_count", int(smoke_.centres().gaussians.size()));
  p.set("farthest", std::pow(std::min(nothing_in_voxels, smoke_.centres().cutoff), 2));
  p.set("samples_along", Vec3(grid.size.cast<double>()));
  p.set("least_source_density", smoke_.least_density());
  p.dispatch(grid.size[0], grid.size[1], grid.size[2]);
}

}  // namespace airlight::gpu::compensated_ray_marching
