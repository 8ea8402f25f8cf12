#include "gpu/compensated_ray_marching/smoke_density.h"

#include <algorithm>
#include <cmath>

#include "scene/media/fitted.h"
#include "scene/media/voxel.h"

namespace airlight::gpu::smoke {
namespace {

using compensated_ray_marching::Options;
using compensated_ray_marching::SmokeField;

constexpr double negligible_widths = 6.257, nothing_beyond = 6;  // scene/media/gaussian_sum.cpp, gaussian_row.cpp

constexpr int slices_of_density = 32, slices_of_sources = 16;  // that an invocation holds

struct GaussianData {
  float center[3], width, amplitude, unused[3] = {0, 0, 0};
};

}  // namespace

SmokeDensity::SmokeDensity(Context& context, const SmokeField& smoke, const Point3& middle, bool paper)
    : slices_(paper ? slices_of_sources : slices_of_density) {
  longest_ = bounding_box(smoke.medium()).size().norm();
  definitions_ = {{"GAUSSIANS", smoke.gaussians() ? "1" : "0"},
                  {"SLICES", std::to_string(slices())},
                  {"PAPER", paper ? "1" : "0"},
                  {"RESIDUAL", "0"}};
  if (const scene::GaussianSum* sum = smoke.gaussians()) {
    std::vector<GaussianData> data;
    for (const scene::Gaussian& g : sum->gaussians) {
      const Vec3 center = g.center - middle;
      if (g.amplitude != 0)
        data.push_back({{float(center[0]), float(center[1]), float(center[2])}, float(g.width), float(g.amplitude)});
    }
    count_ = int(data.size());
    widths2_ = std::pow(std::min(negligible_widths, sum->cutoff), 2);
    farthest_ = std::pow(std::min(nothing_beyond, sum->cutoff), 2);
    values_ = std::make_unique<Buffer>(context, "gaussians of the smoke", data);
    if (!smoke.residual()) return;
    const compensated_ray_marching::StoredResidual& residual = *smoke.residual();
    using compensated::ResidualOnDevice;
    if (const scene::PerfectHash* hash = residual.hash())
      residual_ =
          std::make_unique<ResidualOnDevice>(context, residual.size(), *hash, ResidualOnDevice::Membership::domain);
    else
      residual_ = std::make_unique<ResidualOnDevice>(context, residual.size(), *residual.bricks());
    step_ = residual.step();
    for (const auto& [name, value] : residual_->definitions()) definitions_[name] = value;
    definitions_["RESIDUAL"] = "1";
    set_samples(residual.layout(), middle);
    return;
  }
  const scene::VoxelGrid& grid = *grid_of(smoke.medium().field);
  set_samples(grid, middle);
  values_ = std::make_unique<Buffer>(context, "voxels of the smoke", grid.values);
  definitions_["CLAMPED"] = grid.clamp_border ? "1" : "0";
}

void SmokeDensity::set_samples(const scene::VoxelGrid& grid, const Point3& middle) {
  samples_ = grid.size.cast<double>();
  to_samples_ = grid.rotation.transpose() / grid.voxel_size;
  middle_sample_ = world_to_sample(grid, middle);
  border_ = border_width(grid);
}

void SmokeDensity::bind(Program& p) const {
  values_->bind(at::density);
  if (definitions_.at("GAUSSIANS") == "1") {
    p.set("gaussian_count", count_);
    p.set("farthest", farthest_);
    return;
  }
  p.set("samples_along", samples_);
  p.set("to_samples", to_samples_);
  p.set("middle_sample", middle_sample_);
  p.set("border", border_);
}

void SmokeDensity::bind_residual(Program& p) const {
  if (!residual_) return;
  residual_->bind(p);
  p.set("residual_along", samples_);
  p.set("to_residual", to_samples_);
  p.set("middle_of_residual", middle_sample_);
  p.set("border_of_residual", border_);
  p.set("residual_step", step_);
}

std::vector<std::string> reasons_against(const scene::Scene& scene, const Options& options) {
  std::vector<std::string> reasons;
  const bool paper = options.variant == Options::Variant::paper;
  if (paper && options.paper.store == compensated_ray_marching::ResidualStore::grid)
    reasons.push_back("residual_store = grid; shaders know bricks and hash");
  if (!paper && options.grid.multiple == Options::Grid::Multiple::p1)
    reasons.push_back("multiple = p1; shaders know ordinates");
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const scene::Medium& medium = scene.media[i];
    if (!extinguishes(medium)) continue;
    const std::string why =
        scene::unknown_field<scene::GaussianSum, scene::GridPointer, scene::FittedPointer>(scene.media, i);
    if (!why.empty())
      reasons.push_back(why);
    else if (!std::holds_alternative<scene::Unbounded>(medium.region))
      reasons.push_back(label(scene.media, i) + " is cut off by a region; shaders know none");
  }
  return reasons;
}

}  // namespace airlight::gpu::smoke
