#include "gpu/legendre_fluids/interface.h"

#include "gpu/interface.h"

namespace airlight::gpu::legendre_fluids {
namespace {

const std::vector<Binding> bindings = {{"START", at::start},
                                       {"STATE", at::state},
                                       {"RATES", at::rates},
                                       {"PRESSURE", at::pressure},
                                       {"SPREAD", at::spread},
                                       {"STATUS", at::status},
                                       {"GATHERED", at::gathered},
                                       {"REGIONS", at::regions},
                                       {"MATRICES", at::matrices},
                                       {"DISTANCES", at::distances},
                                       {"REACHED", at::reached},
                                       {"COLUMNS", at::columns},
                                       {"AIRLIGHT_LAYER", at::airlight_layer},
                                       {"LIT", at::lit},
                                       {"TRANSMITTANCE_LAYER", at::transmittance_layer},
                                       {"AMBIENT_LAYER", at::ambient_layer},
                                       {"SURFACE_LAYER", at::surface_layer},
                                       {"MEAN_LAYER", at::mean_layer},
                                       {"SEEN", at::seen},
                                       {"TARGETS", at::targets},
                                       {"STRETCHES", at::stretches},
                                       {"WAYS", at::ways},
                                       {"WALKED", at::walked},
                                       {"SHADES", at::shades},
                                       {"PARTICLES", at::particles},
                                       {"TABLES", at::tables},
                                       {"WORK", at::work},
                                       {"POINTS", at::values},
                                       {"DIRECT", at::direct},
                                       {"FACES", at::faces},
                                       {"RAY_ENDS", at::ray_ends},
                                       {"KEPT", at::kept},
                                       {"FLOATS", at::floats},
                                       {"DENSITIES", at::densities},
                                       {"RULE", at::rule}};

}  // namespace

Program& program(Context& context, const std::string& file, int x, int y, Definitions definitions) {
  define(bindings, definitions);
  const auto number = [&](const char* name, auto value) { definitions[name] = std::to_string(int(value)); };
  number("GOES_TO_POINTS", GoesOn::to_points);
  number("GOES_TO_MODES", GoesOn::to_modes);
  number("COMES_FROM_POINTS", ComesFrom::points);
  number("COMES_FROM_MODES", ComesFrom::modes);
  number("COMES_FROM_FORCES", ComesFrom::forces);
  number("LOCAL_SIZE_X", x);
  number("LOCAL_SIZE_Y", y);
  return context.program("legendre_fluids/" + file + ".comp", definitions);
}

}  // namespace airlight::gpu::legendre_fluids
