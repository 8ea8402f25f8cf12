#include "gpu/compensated_ray_marching/interface.h"

#include "gpu/interface.h"
#include "methods/compensated_ray_marching/compensated_march.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

const std::vector<Binding> bindings = {{"COLUMNS", at::columns},
                                       {"POWERS", at::powers},
                                       {"HARMONICS", at::harmonics},
                                       {"FOUND_COLUMNS", at::found_columns},
                                       {"HIDDEN_NODES", at::hidden_nodes},
                                       {"NODE_OF_CELL", at::node_of_cell},
                                       {"NODES", at::nodes},
                                       {"SINGLE", at::single},
                                       {"RESULT", at::result},
                                       {"SOURCE", at::source},
                                       {"STATE", at::state},
                                       {"EMITTED", at::emitted},
                                       {"LIGHT", at::light},
                                       {"WAYS", at::ways},
                                       {"DENSITIES", at::densities},
                                       {"WEIGHTED", at::weighted},
                                       {"STEPS", at::steps},
                                       {"MEANS", at::means},
                                       {"PARTS", at::parts},
                                       {"TOWARDS_LIGHT", at::towards_light},
                                       {"RADIANCE", at::radiance},
                                       {"GREATEST", at::greatest},
                                       {"LOGARITHMS", at::logarithms},
                                       {"VOLUME", at::volume},
                                       {"BALANCE", at::balance},
                                       {"EDGES", at::edges},
                                       {"EDGE_NODES", at::edge_nodes},
                                       {"EDGE_WEIGHTS", at::edge_weights},
                                       {"DENSITY", at::density},
                                       {"RANGES", at::ranges},
                                       {"AIRLIGHT_LAYER", at::airlight_layer},
                                       {"TRANSMITTANCE_LAYER", at::transmittance_layer},
                                       {"SURFACE_LAYER", at::surface_layer},
                                       {"AMBIENT_LAYER", at::ambient_layer},
                                       {"MEAN_LAYER", at::mean_layer},
                                       {"COLUMN", at::column},
                                       {"DISTANCES", at::distances},
                                       {"PRIMITIVES", at::primitives},
                                       {"LIT", at::lit},
                                       {"SEEN", at::seen},
                                       {"OPEN", at::open},
                                       {"CENTRE_TABLES", at::centre_tables},
                                       {"CENTRES", at::centres},
                                       {"SPHERES", at::spheres},
                                       {"PASSED", at::passed},
                                       {"SINGLE_BANDS", at::single_bands},
                                       {"LIGHT_BANDS", at::light_bands},
                                       {"TERMS", at::terms},
                                       {"AGAIN", at::again},
                                       {"CENTRE_SOURCES", at::centre_sources},
                                       {"MATRIX", at::matrix},
                                       {"ROW_SCALES", at::row_scales},
                                       {"VECTORS", at::vectors},
                                       {"SYSTEMS", at::systems},
                                       {"MAP_TEXELS", at::map_texels},
                                       {"CIRCLE", at::circle},
                                       {"FOURIER", at::fourier},
                                       {"ROW_WEIGHTS", at::row_weights},
                                       {"PROJECTED", at::projected}};

}  // namespace

Program& program(Context& context, const std::string& file, int x, int y, Definitions definitions) {
  using airlight::compensated_ray_marching::SliceWeight;
  define(bindings, definitions);
  const auto number = [&](const char* name, auto value) { definitions[name] = std::to_string(int(value)); };
  number("KEPT", kept);
  number("WEIGHT_EXACT", SliceWeight::exact);
  number("WEIGHT_PAPER", SliceWeight::paper);
  number("LOCAL_SIZE_X", x);
  number("LOCAL_SIZE_Y", y);
  return context.program("compensated_ray_marching/" + file + ".comp", definitions);
}

}  // namespace airlight::gpu::compensated_ray_marching
