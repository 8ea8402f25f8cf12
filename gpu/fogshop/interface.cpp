#include "gpu/fogshop/interface.h"

#include <fmt/format.h>

#include <cstddef>

#include "gpu/interface.h"
#include "methods/fogshop/surface_psf.h"

namespace airlight::gpu::fogshop {
namespace {

const std::vector<Binding> bindings = {{"GAUSSIANS", at::gaussians},
                                       {"LIGHTS", at::lights},
                                       {"LIGHT_MAPS", at::light_maps},
                                       {"PIXELS", at::pixels},
                                       {"SURFACE", at::surface},
                                       {"DEPTHS", at::depths},
                                       {"FOG_TABLES", at::fog_tables},
                                       {"TILE_LISTS", at::tile_lists},
                                       {"DISTANCES", at::distances},
                                       {"EDGES", at::edges},
                                       {"RAY_VALUES", at::ray_values},
                                       {"LOW_PIXELS", at::low_pixels},
                                       {"LOW_DISTANCES", at::low_distances},
                                       {"ENVIRONMENT_LIGHT", at::environment_light},
                                       {"PSF_BANDS", at::psf_bands},
                                       {"SKY_VOLUME", at::sky_volume},
                                       {"BEAMS", at::beams},
                                       {"OPEN_BEAMS", at::open_beams},
                                       {"PRIMITIVES", at::primitives},
                                       {"LIGHT_PLACES", at::light_places},
                                       {"SCATTERED", at::scattered},
                                       {"SURFACE_TABLES", at::surface_tables},
                                       {"TRANSFER", at::transfer},
                                       {"LIGHT_LISTS", at::light_lists},
                                       {"AIRLIGHT_LAYER", at::airlight_layer},
                                       {"TRANSMITTANCE_LAYER", at::transmittance_layer},
                                       {"MEAN_LAYER", at::mean_layer},
                                       {"SEEN", at::seen}};

const std::vector<Layout> layouts = {{"gaussians[0].a", offsetof(GaussianData, a), sizeof(GaussianData)},
                                     {"gaussians[0].place", offsetof(GaussianData, place), sizeof(GaussianData)},
                                     {"lights[0].intensity", offsetof(LightData, intensity), 0},
                                     {"lights[0].map_offset", offsetof(LightData, map_offset), 0},
                                     {"lights[1].axis_z", sizeof(LightData) + offsetof(LightData, axis_z), 0}};

template <class Values>
std::string listed(const Values& values) {
  std::string text;
  for (const double v : values) text += fmt::format("{}{:.9e}", text.empty() ? "" : ", ", v);
  return text;
}

}  // namespace

std::map<std::string, std::string> dawson_definitions() {
  return {{"DAWSON_END", fmt::format("{:.9e}", airlight::fogshop::DawsonFit::end)},
          {"DAWSON_NUMERATOR", listed(airlight::fogshop::DawsonFit::numerator)},
          {"DAWSON_DENOMINATOR", listed(airlight::fogshop::DawsonFit::denominator)}};
}

Program& program(Context& context, const std::string& file, std::map<std::string, std::string> definitions) {
  define(bindings, definitions);
  Program& made = context.program(file, definitions);
  check_layouts(made, file, layouts);
  return made;
}

}  // namespace airlight::gpu::fogshop
