// The voxel grids of media on the device: 3D textures, or one storage buffer for all.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/texture_3d.h"
#include "reference/ray_marcher/layer.h"

namespace airlight::gpu::ray_marcher {

// automatic: textures on a GPU; on a software renderer, which reads buffers faster, a buffer where it is large enough.
enum class GridStorage { automatic, buffer, texture };
void bind_storage(scene::SettingBinder&, GridStorage&);  // the setting grid_storage

class GridsOnDevice {
 public:
  // Throws Unavailable in one line where the device has no room.
  GridsOnDevice(Context&, const std::vector<airlight::ray_marcher::Layer>&, GridStorage);

  // Other samples of grids of the same sizes: uploads those that are not shared with the frame before.
  void become(const std::vector<airlight::ray_marcher::Layer>&);

  int textures() const { return int(textures_.size()); }  // 0: the buffer has the values
  std::string description() const;                        // one line; empty without grids
  // The buffer to binding 2, textures to units 0 and on.
  void bind() const;

 private:
  std::vector<std::shared_ptr<const airlight::ray_marcher::GridSamples>> uploaded_;  // by grid
  std::size_t grids_ = 0, samples_ = 0;
  std::unique_ptr<Buffer> buffer_;
  std::vector<std::unique_ptr<Texture3D>> textures_;
};

}  // namespace airlight::gpu::ray_marcher
