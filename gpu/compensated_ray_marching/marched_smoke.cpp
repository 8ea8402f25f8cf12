#include "gpu/compensated_ray_marching/marched_smoke.h"

#include <algorithm>
#include <cmath>

#include "gpu/compensated_ray_marching/gaussian_data.h"
#include "scene/media/fitted.h"
#include "scene/media/voxel.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::SmokeField;

constexpr double negligible_widths = 6.257, nothing_beyond = 6;  // scene/media/gaussian_sum.cpp, gaussian_row.cpp

constexpr int slices_of_density = 32, slices_of_sources = 16;  // that an invocation holds

}  // namespace

SmokeDensity::SmokeDensity(Context& context, const SmokeField& smoke, const Point3& middle, bool paper)
    : slices_(paper ? slices_of_sources : slices_of_density), longest_(bounding_box(smoke.medium()).size().norm()) {
  definitions_ = {
      {"SLICES", std::to_string(slices())}, {"PAPER", paper ? "1" : "0"}, {"VOLUME", smoke.voxels() ? "1" : "0"}};
  const auto* sum = std::get_if<scene::GaussianSum>(&smoke.medium().field);
  if (sum)
    set_gaussians(context, paper ? smoke.centres() : *sum, middle);
  else
    set_voxels(context, *grid_of(smoke.medium().field), middle);
  set_region(smoke.medium().region, middle);
}

SmokeDensity::SmokeDensity(Context& context, const scene::GaussianSum& sum, const Point3& middle)
    : slices_(slices_of_density) {
  set_gaussians(context, sum, middle);
}

void SmokeDensity::set_gaussians(Context& context, const scene::GaussianSum& sum, const Point3& middle) {
  definitions_["GAUSSIANS"] = "1";
  std::vector<GaussianData> data;
  for (const scene::Gaussian& g : sum.gaussians)
    if (g.amplitude != 0) data.push_back(gaussian_data(g.center - middle, g.width, g.amplitude));
  count_ = int(data.size());
  widths2_ = std::pow(std::min(negligible_widths, sum.cutoff), 2);
  farthest_ = std::pow(std::min(nothing_beyond, sum.cutoff), 2);
  values_ = std::make_unique<Buffer>(context, "gaussians of the smoke", data);
}

void SmokeDensity::set_voxels(Context& context, const scene::VoxelGrid& grid, const Point3& middle) {
  definitions_["GAUSSIANS"] = "0";
  definitions_["CLAMPED"] = grid.clamp_border ? "1" : "0";
  samples_ = grid.size.cast<double>();
  to_samples_ = grid.rotation.transpose() / grid.voxel_size;
  middle_sample_ = world_to_sample(grid, middle);
  border_ = border_width(grid);
  values_ = std::make_unique<Buffer>(context, "voxels of the smoke", grid.values);
}

void SmokeDensity::set_region(const scene::Region& region, const Point3& middle) {
  region_kind_ = int(region.index());  // as smoke_region.glsl counts them
  if (const auto* box = std::get_if<Box>(&region)) {
    region_a_ = box->lo - middle;
    region_b_ = box->hi - middle;
  } else if (const auto* sphere = std::get_if<scene::Sphere>(&region)) {
    region_a_ = sphere->center - middle;
    region_b_[0] = sphere->radius;
  } else if (const auto* slab = std::get_if<scene::Slab>(&region)) {
    const double at = slab->normal.dot(middle);
    region_a_ = slab->normal;
    region_b_ = {slab->lo - at, slab->hi - at, 0};
  }
}

void SmokeDensity::bind(Program& p) const {
  values_->bind(at::density);
  p.set("region_kind", region_kind_);
  p.set("region_a", region_a_);
  p.set("region_b", region_b_);
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

std::vector<std::string> unsupported_smoke(const scene::Scene& scene) {
  std::vector<std::string> reasons;
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const scene::Medium& medium = scene.media[i];
    if (!extinguishes(medium)) continue;
    const std::string why =
        scene::unknown_field<scene::GaussianSum, scene::GridPointer, scene::FittedPointer>(scene.media, i);
    if (!why.empty()) reasons.push_back(why);
  }
  return reasons;
}

}  // namespace airlight::gpu::compensated_ray_marching
