#include "gpu/ray_marcher/interface.h"

#include <cstddef>

#include "gpu/interface.h"
#include "gpu/ray_marcher/scene_data.h"

namespace airlight::gpu::ray_marcher {
namespace {

const std::vector<Binding> bindings = {{"LAYERS", at::layers},
                                       {"LINE_RULE", at::line_rule},
                                       {"LIGHT_MAPS", at::light_maps},
                                       {"GAUSSIANS", at::gaussians},
                                       {"GRID_VALUES", at::grid_values},
                                       {"FREE_DISTANCES", at::free_distances},
                                       {"LIGHTS", at::lights},
                                       {"DISTANCES", at::distances},
                                       {"PRIMITIVES", at::primitives},
                                       {"PIXELS", at::pixels},
                                       {"SURFACE", at::surface},
                                       {"MATERIALS", at::materials},
                                       {"SOLIDS", at::solids},
                                       {"ROUNDS", at::rounds},
                                       {"REFLECTANCES", at::reflectances},
                                       {"AIRLIGHT_LAYER", at::airlight_layer},
                                       {"TRANSMITTANCE_LAYER", at::transmittance_layer},
                                       {"MEAN_LAYER", at::mean_layer},
                                       {"TOTALS", at::totals},
                                       {"SEEN", at::seen}};

const std::vector<Layout> layouts = {{"layers[0].albedo", offsetof(LayerData, albedo), 0},
                                     {"layers[0].shape", offsetof(LayerData, shape), 0},
                                     {"layers[0].field_frame[0]", offsetof(LayerData, field_frame), 0},
                                     {"layers[0].count", offsetof(LayerData, count), 0},
                                     {"layers[0].first_brick", offsetof(LayerData, first_brick), 0},
                                     {"layers[1].most_varied", sizeof(LayerData) + offsetof(LayerData, most_varied), 0},
                                     {"gaussians[0].limit", offsetof(GaussianData, limit), sizeof(GaussianData)},
                                     {"lights[0].kind", offsetof(LightData, kind), sizeof(LightData)},
                                     {"lights[0].cos_outer", offsetof(LightData, cos_outer), sizeof(LightData)},
                                     {"blockers[0].normal", offsetof(SolidData, normal), sizeof(SolidData)}};

}  // namespace

Program& program(Context& context, const std::string& file, std::map<std::string, std::string> definitions) {
  define(bindings, definitions);
  Program& made = context.program(file, definitions);
  check_layouts(made, file, layouts);
  return made;
}

}  // namespace airlight::gpu::ray_marcher
