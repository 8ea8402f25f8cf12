#include "gpu/ray_marcher/grid_field.h"

#include <fmt/format.h>

#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "scene/base/error.h"

namespace airlight::gpu::ray_marcher {

void bind_storage(scene::SettingBinder& b, GridStorage& storage) {
  b.choice("grid_storage", storage,
           {{"auto", GridStorage::automatic}, {"buffer", GridStorage::buffer}, {"texture", GridStorage::texture}},
           "voxel grids on the device; auto: textures, on a software renderer a buffer while one is enough");
}

namespace {

std::vector<std::shared_ptr<const airlight::ray_marcher::GridSamples>> samples_of(
    const std::vector<airlight::ray_marcher::Layer>& layers) {
  std::vector<std::shared_ptr<const airlight::ray_marcher::GridSamples>> samples;
  for (const airlight::ray_marcher::Layer& layer : layers)
    if (layer.grid) samples.push_back(layer.grid->samples);
  return samples;
}

}  // namespace

GridsOnDevice::GridsOnDevice(Context& context, const std::vector<airlight::ray_marcher::Layer>& layers,
                             GridStorage storage)
    : uploaded_(samples_of(layers)) {
  for (const airlight::ray_marcher::Layer& layer : layers)
    if (layer.grid) {
      ++grids_;
      samples_ += std::size_t(layer.grid->size[0]) * layer.grid->size[1] * layer.grid->size[2];
    }
  const bool fits = samples_ * sizeof(float) <= context.limits().storage_block;
  if (storage == GridStorage::automatic)
    storage = context.software() && fits ? GridStorage::buffer : GridStorage::texture;
  if (grids_ == 0 || storage == GridStorage::buffer) {
    // Asked for by its size first: a list that the device will not take need not be made.
    if (!fits) Buffer(context, "voxel grids", samples_ * sizeof(float));
    buffer_ = std::make_unique<Buffer>(context, "voxel grids", grid_data(layers));
    return;
  }
  if (grids_ > std::size_t(context.limits().texture_units))
    throw Unavailable(fmt::format("gpu: {} voxel grids, {} offers {} textures to a shader", grids_, context.renderer(),
                                  context.limits().texture_units));
  for (const airlight::ray_marcher::Layer& layer : layers) {
    if (!layer.grid) continue;
    const int* size = layer.grid->size;
    textures_.push_back(
        std::make_unique<Texture3D>(context, "voxel grid", std::array<int, 3>{size[0], size[1], size[2]}));
    textures_.back()->upload([&](int z, std::vector<float>& values) { grid_slice(*layer.grid, z, values); });
  }
}

void GridsOnDevice::become(const std::vector<airlight::ray_marcher::Layer>& layers) {
  auto samples = samples_of(layers);
  if (samples == uploaded_) return;
  if (textures_.empty()) buffer_->upload(grid_data(layers));
  std::size_t i = 0;
  for (const airlight::ray_marcher::Layer& layer : layers) {
    if (!layer.grid) continue;
    if (!textures_.empty() && samples[i] != uploaded_[i])
      textures_[i]->upload([&](int z, std::vector<float>& values) { grid_slice(*layer.grid, z, values); });
    ++i;
  }
  uploaded_ = std::move(samples);
}

std::string GridsOnDevice::description() const {
  if (grids_ == 0) return {};
  return fmt::format("{} of {:.1f} MiB",
                     buffer_ ? "a storage buffer" : fmt::format("{} 3D texture{}", grids_, grids_ == 1 ? "" : "s"),
                     double(samples_) * sizeof(float) / (1 << 20));
}

void GridsOnDevice::bind() const {
  if (buffer_) buffer_->bind(at::grid_values);
  for (std::size_t i = 0; i < textures_.size(); ++i) textures_[i]->bind(int(i));
}

}  // namespace airlight::gpu::ray_marcher
