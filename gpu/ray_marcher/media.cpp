#include "gpu/ray_marcher/media.h"

#include <fmt/format.h>

#include <algorithm>

#include "gpu/ray_marcher/interface.h"
#include "gpu/ray_marcher/scene_data.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"

namespace airlight::gpu::ray_marcher {

using airlight::ray_marcher::Layer;

double density_iterations(const Layer& layer) {
  if (const auto* box = std::get_if<scene::LegendrePointer>(&layer.medium->field))
    return scene::tensor_size((*box)->shape());
  if (const auto* fog = std::get_if<scene::FogmapPointer>(&layer.medium->field))
    return 16 + double(height_breaks((*fog)->profile).size());
  return layer.gaussians ? double(layer.gaussians->count) : 1;
}

bool is_series(const Layer& layer) { return layer.varies && !layer.grid && !layer.gaussians; }

MediaOnDevice::MediaOnDevice(Context& context, const std::vector<Layer>& layers, const Point3& middle,
                             GridStorage storage)
    : context_(context), middle_(middle), count_(int(layers.size())), grids_(context, layers, storage) {
  for (const Layer& layer : layers) {
    has_grids_ = has_grids_ || layer.grid;
    has_gaussians_ = has_gaussians_ || layer.gaussians;
  }
  upload_lists(layers);
  refill(bricks_, context, "maps of empty space", brick_data(layers));
  uploaded_ = layers;
  become(layers, middle);
}

void MediaOnDevice::upload_lists(const std::vector<Layer>& layers) {
  series_ = series_data(layers);
  if (series_.empty())
    refill(gaussians_, context_, "Gaussians", gaussian_data(layers));
  else
    refill(gaussians_, context_, "Gaussians, maps, series", series_);
}

bool MediaOnDevice::is_like(const std::vector<Layer>& layers) const {
  const bool has_series = std::any_of(layers.begin(), layers.end(), is_series);
  return has_series == !series_.empty() &&
         std::equal(layers.begin(), layers.end(), uploaded_.begin(), uploaded_.end(),
                    [](const Layer& a, const Layer& b) {
                      return bool(a.grid) == bool(b.grid) && bool(a.gaussians) == bool(b.gaussians) &&
                             (!a.grid || std::equal(a.grid->size, a.grid->size + 3, b.grid->size));
                    });
}

void MediaOnDevice::become(const std::vector<Layer>& layers, const Point3& middle) {
  middle_ = middle;
  const std::vector<LayerData> data = layer_data(layers, middle, grids_.textures() > 0);
  const auto* bytes = reinterpret_cast<const char*>(data.data());
  if (std::vector<char> now(bytes, bytes + data.size() * sizeof(LayerData)); now != layers_uploaded_) {
    refill(layers_, context_, "layers", data);
    layers_uploaded_ = std::move(now);
  }
  const auto differ = [&](const auto& part) {
    return !std::equal(layers.begin(), layers.end(), uploaded_.begin(), uploaded_.end(),
                       [&](const Layer& a, const Layer& b) { return part(a) == part(b); });
  };
  if (differ([](const Layer& layer) { return layer.gaussians; }) || series_ != series_data(layers))
    upload_lists(layers);
  if (differ([](const Layer& layer) { return layer.grid ? layer.grid->samples : nullptr; })) {
    grids_.become(layers);
    refill(bricks_, context_, "maps of empty space", brick_data(layers));
  }
  uploaded_ = layers;
}

std::map<std::string, std::string> MediaOnDevice::definitions() const {
  return {{"LAYERS", std::to_string(count_)},
          {"GRIDS", has_grids_ ? "1" : "0"},
          {"TEXTURES", std::to_string(grids_.textures())},
          {"GAUSSIANS", has_gaussians_ ? "1" : "0"},
          {"OTHER_FIELDS", series_.empty() ? "0" : "1"}};
}

void MediaOnDevice::bind(LinkedProgram& program) const {
  layers_->bind_as(GL_UNIFORM_BUFFER, at::layers);
  gaussians_->bind(at::gaussians);
  grids_.bind();
  bricks_->bind(at::free_distances);
  program.set("layer_count", count_);
}

std::vector<std::string> unknown_media(const std::vector<scene::Medium>& media) {
  std::vector<std::string> reasons;
  const auto visible = std::count_if(media.begin(), media.end(), scene::extinguishes);
  if (visible > std::ptrdiff_t(most_layers))
    reasons.push_back(fmt::format("{} media with extinction: a uniform block holds {}", visible, most_layers));
  return reasons;
}

}  // namespace airlight::gpu::ray_marcher
