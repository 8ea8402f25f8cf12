#include "gpu/fogshop/background.h"

#include "gpu/fogshop/interface.h"
#include "gpu/view_uniforms.h"

namespace airlight::gpu::fogshop {

Background::Background(Context& context, const scene::Scene& scene, const FogOnDevice& fog) : lights_(context, scene) {
  for (int i = 0; i < lights_.count(); ++i) {
    Definitions definitions = lights_.definitions(i);
    definitions.insert({{"LOCAL_SIZE_X", "8"}, {"LOCAL_SIZE_Y", "8"}});
    programs_.push_back(&fog.program("fogshop/background.comp", definitions));
  }
}

void Background::draw(const FogOnDevice& fog, const scene::View& view, const Buffer* distances, const Buffer* pixels,
                      const Buffer& surface) {
  for (int i = 0; i < lights_.count(); ++i) {
    Program& p = *programs_[i];
    fog.use(p);
    fog.bind();
    if (distances) distances->bind(at::distances);
    if (pixels) pixels->bind(at::pixels);
    surface.bind(at::surface);
    lights_.bind(i, p);
    set_view(p, view);
    p.set("has_distances", distances != nullptr);
    p.set("has_airlight", pixels != nullptr);
    p.dispatch(view.width, view.height);
  }
}

}  // namespace airlight::gpu::fogshop
