#include "gpu/froxel_fog/interface.h"

#include "gpu/interface.h"
#include "gpu/ray_marcher/interface.h"

namespace airlight::gpu::froxel_fog {
namespace {

const std::vector<Binding> froxel_bindings = {{"LIGHT", at::light},
                                              {"MEDIA", at::media},
                                              {"SLICES", at::slices},
                                              {"ENDS", at::ends},
                                              {"FRAMES", at::frames},
                                              {"FROXEL_TOTALS", at::totals},
                                              {"HISTORY_LIGHT", at::history_light},
                                              {"HISTORY_MEDIA", at::history_media},
                                              {"FITTED", at::fitted},
                                              {"HISTORY_SLICES", at::history_slices},
                                              {"FILTERED_LIGHT", at::filtered_light},
                                              {"FILTERED_MEDIA", at::filtered_media},
                                              {"AIRLIGHT", at::airlight},
                                              {"TRANSMITTANCE", at::transmittance}};

}  // namespace

Program& program(Context& context, const std::string& file, std::map<std::string, std::string> definitions) {
  define(froxel_bindings, definitions);
  return ray_marcher::program(context, file, definitions);
}

}  // namespace airlight::gpu::froxel_fog
