// Eq. 28 of Zhou et al. 2007 on the device: the airlight of an environment.
#include <array>
#include <cmath>

#include "gpu/fogshop/fog.h"
#include "gpu/fogshop/interface.h"
#include "gpu/view_uniforms.h"

namespace airlight::gpu::fogshop {

void FogOnDevice::upload_environment(const airlight::fogshop::EnvironmentLighting& lighting) {
  const Use use_context(context_);
  std::vector<std::array<float, 4>> light;
  for (int l = 0; l < lighting.order(); ++l)
    for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
      const Rgb value = std::sqrt(4 * pi / (2 * l + 1)) * model_.fog.albedo * lighting.light()[i];
      light.push_back({float(value[0]), float(value[1]), float(value[2]), 0});
    }
  const std::vector<double>& table = lighting.bands().values();
  refill(light_, context_, "harmonics of the environment", light);
  if (!band_table_)  // it depends on the settings alone
    refill(band_table_, context_, "bands of the PSF", std::vector<float>(table.begin(), table.end()));
  bands_ = lighting.order();
  band_depths_ = lighting.bands().depths();
  programs_.environment = &program(
      "fogshop/environment.comp", {{"LOCAL_SIZE_X", "8"}, {"LOCAL_SIZE_Y", "8"}, {"SH_ORDER", std::to_string(bands_)}});
}

void FogOnDevice::add_environment(const scene::View& view, bool has_distances, Frame& frame) {
  frame.timer.begin("environment");
  light_->bind(at::environment_light);
  band_table_->bind(at::psf_bands);
  Program& p = *programs_.environment;
  using Table = airlight::fogshop::PsfBands;
  set_camera(p, view);
  p.set("extinction_ratio", model_.fog.extinction_ratio);
  p.set("has_distances", has_distances);
  p.set("everywhere", model_.options.everywhere());
  p.set("sh_order", bands_);
  p.set("band_depths", band_depths_);
  p.set("log_least_depth", std::log(Table::least_depth));
  p.set("log_depth_range", std::log(Table::greatest_depth / Table::least_depth));
  p.dispatch(view.width, view.height);
}

}  // namespace airlight::gpu::fogshop
