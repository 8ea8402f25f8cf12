#include "gpu/ray_marcher/media.h"

#include <fmt/format.h>

#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"

namespace airlight::gpu::ray_marcher {

MediaOnDevice::MediaOnDevice(Context& context, const std::vector<airlight::ray_marcher::Layer>& layers,
                             const Point3& middle, GridStorage storage)
    : middle_(middle),
      count_(int(layers.size())),
      grids_(context, layers, storage),
      layers_(context, "layers", layer_data(layers, middle, grids_.textures() > 0)),
      gaussians_(context, "Gaussians", gaussian_data(layers)),
      bricks_(context, "maps of empty space", brick_data(layers)) {
  for (const airlight::ray_marcher::Layer& layer : layers) {
    has_grids_ = has_grids_ || layer.grid;
    has_gaussians_ = has_gaussians_ || layer.gaussians;
  }
}

std::map<std::string, std::string> MediaOnDevice::definitions() const {
  return {{"LAYERS", std::to_string(count_)},
          {"GRIDS", has_grids_ ? "1" : "0"},
          {"TEXTURES", std::to_string(grids_.textures())},
          {"GAUSSIANS", has_gaussians_ ? "1" : "0"}};
}

void MediaOnDevice::bind(LinkedProgram& program) const {
  layers_.bind_as(GL_UNIFORM_BUFFER, at::layers);
  gaussians_.bind(at::gaussians);
  grids_.bind();
  bricks_.bind(at::free_distances);
  program.set("layer_count", count_);
}

std::vector<std::string> unknown_media(const std::vector<scene::Medium>& media) {
  std::vector<std::string> reasons;
  if (media.size() > most_layers)
    reasons.push_back(fmt::format("{} media: the shader has room for {}", media.size(), most_layers));
  for (std::size_t i = 0; i < media.size(); ++i) {
    const std::string why =
        scene::unknown_field<scene::Homogeneous, scene::GaussianSum, scene::GridPointer, scene::FittedPointer>(media,
                                                                                                               i);
    if (!why.empty()) reasons.push_back(why);
  }
  return reasons;
}

}  // namespace airlight::gpu::ray_marcher
