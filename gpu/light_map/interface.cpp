#include "gpu/light_map/interface.h"

#include "gpu/interface.h"
#include "gpu/ray_marcher/interface.h"

namespace airlight::gpu::light_map {

Program& program(Context& context, const std::string& file, std::map<std::string, std::string> definitions) {
  define(
      {{"PARTS", at::parts}, {"STEPS", at::steps}, {"TEXELS", at::texels}, {"NODES", at::nodes}, {"WAVES", at::waves}},
      definitions);
  return ray_marcher::program(context, file, definitions);
}

}  // namespace airlight::gpu::light_map
