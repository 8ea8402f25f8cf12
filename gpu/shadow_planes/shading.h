// The dispatches that shade a picture: one per light and air, then the film's layers.
#pragma once
#include <memory>
#include <vector>

#include "gpu/raster/surfaces_on_device.h"
#include "gpu/shadow_planes/airlight_terms_on_device.h"
#include "gpu/shadow_planes/fan_on_device.h"
#include "gpu/shadow_planes/vertex_values.h"
#include "scene/renderer.h"

namespace airlight::gpu {

// What lights leave in a picture.
struct LitPicture {
  LitPicture(Context&, const scene::View&, bool shadows);  // shadows: edges are crossed
  scene::View view;
  std::unique_ptr<Buffer> primitives;  // of the first hits; null: there are none
  Buffer pixels;                       // the layout of pixels.glsl
  Buffer states;                       // that of state.glsl
  // Lit parts, crossings, gatherings after the first; of the last dispatch: unfinished pixels; whether loops were cut.
  Buffer counters;
};

class PlaneShading {
 public:
  // Uploads materials. `surfaces` is null where there are none, nor balls of lights; all must live on. The pointer may
  // come to point to the same scene with other lights.
  PlaneShading(Context&, const std::shared_ptr<const scene::Scene>&, const shadow_planes::Options&,
               const AirlightTermsOnDevice&, const SurfacesOnDevice* surfaces);

  // Of one light, the edges whose planes rays may cross: null where nothing casts a shadow.
  struct Edges {
    const LightEdges* edges = nullptr;
    const FanOnDevice* fan = nullptr;
  };
  // Adds an air (-1: there is none) as a light shows it, and with the first of them what surfaces reflect of the light.
  // `counts`: m where rays begin, one number or one for every pixel; `values` is null where the airlight is computed
  // for every pixel.
  void add(LitPicture&, int light, int term, const std::vector<int>& counts, const Edges&, const VertexValues*) const;

  // Layers of 3 floats per pixel.
  struct Layers {
    Buffer airlight, transmittance, surface, mean;
  };
  void compose(const LitPicture&, const Layers&) const;

 private:
  std::unique_ptr<Buffer> left_out(const LightEdges*, const Box&, const Point3& light) const;

  Context& context_;
  const std::shared_ptr<const scene::Scene>& scene_;
  shadow_planes::Options options_;
  const AirlightTermsOnDevice& airlight_terms_;
  const SurfacesOnDevice* surfaces_;
  Buffer materials_, tables_;
};

}  // namespace airlight::gpu
