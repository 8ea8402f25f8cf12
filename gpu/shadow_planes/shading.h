// The dispatches that shade a picture: one per light, then the film's layers.
#pragma once
#include <memory>
#include <vector>

#include "gpu/raster/surfaces_on_device.h"
#include "gpu/shadow_planes/tile_bins.h"
#include "methods/shadow_planes/options.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class PlaneShading {
 public:
  // Uploads media, materials and the evaluator's numbers. `surfaces` (null: there are none, nor balls of lights) and
  // the scene must live on.
  PlaneShading(Context&, const scene::Scene&, const shadow_planes::Options&, const SurfacesOnDevice* surfaces);

  // What lights leave in a picture.
  struct Picture {
    Picture(Context&, const scene::View&);
    scene::View view;
    std::unique_ptr<Buffer> primitives;  // of the first hits; null: there are none
    Buffer airlight, reflected;          // 4 floats per pixel
    Buffer counters;
  };

  // Adds a light. `counts`: m where rays begin, one number or one for every pixel; `bins`: null where nothing casts a
  // shadow.
  void add(Picture&, int light, const std::vector<int>& counts, const TileBins* bins, const LightEdges*) const;

  // Layers of 3 floats per pixel.
  struct Layers {
    Buffer airlight, transmittance, surface, mean;
  };
  void compose(const Picture&, const Layers&) const;

 private:
  Context& context_;
  const scene::Scene& scene_;
  shadow_planes::Options options_;
  const SurfacesOnDevice* surfaces_;
  bool medium_, bounded_, grey_;
  int degree_ = 0;
  Buffer media_, from_lights_, evaluator_, materials_, tables_;
};

}  // namespace airlight::gpu
