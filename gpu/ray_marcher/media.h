// The media of a scene on the device, as layer.glsl reads them. Renderers of other folders share them.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/linked_program.h"
#include "gpu/ray_marcher/grid_field.h"

namespace airlight::gpu::ray_marcher {

class MediaOnDevice {
 public:
  // Uploads. Places on the device are relative to `middle`. Throws Unavailable where the device has no room for a grid.
  MediaOnDevice(Context&, const std::vector<airlight::ray_marcher::Layer>&, const Point3& middle, GridStorage);

  // Do programs for these media serve those, and buffers too: layers of the same kinds, grids of the same sizes?
  bool is_like(const std::vector<airlight::ray_marcher::Layer>&) const;
  // Becomes such media, and uploads what has changed.
  void become(const std::vector<airlight::ray_marcher::Layer>&, const Point3& middle);

  const Point3& middle() const { return middle_; }
  const GridsOnDevice& grids() const { return grids_; }
  // LAYERS, GRIDS, TEXTURES, GAUSSIANS and OTHER_FIELDS (fogmaps, Legendre boxes), for a program that includes layer.glsl.
  std::map<std::string, std::string> definitions() const;
  // Binds uniform block 0, storage blocks 1 to 3 and the textures, sets layer_count.
  void bind(LinkedProgram&) const;

 private:
  void upload_lists(const std::vector<airlight::ray_marcher::Layer>&);

  Context& context_;
  Point3 middle_;
  int count_;
  std::vector<airlight::ray_marcher::Layer> uploaded_;  // but for their media, which may be gone
  bool has_grids_ = false, has_gaussians_ = false;
  GridsOnDevice grids_;
  std::vector<char> layers_uploaded_;
  std::vector<float> series_;  // as uploaded; empty: no fogmap, no Legendre box
  std::unique_ptr<Buffer> layers_, gaussians_, bricks_;
};

// A fogmap or a Legendre box: a field without kernel on the CPU. Iterations of loops that a density of the layer takes.
bool is_series(const airlight::ray_marcher::Layer&);
double density_iterations(const airlight::ray_marcher::Layer&);

// Why the device's media are not these, one line each: there are too many.
std::vector<std::string> unknown_media(const std::vector<scene::Medium>&);

}  // namespace airlight::gpu::ray_marcher
