// The dispatches that shade a picture: one per light and air, then the film's layers.
#pragma once
#include <map>
#include <memory>

#include "gpu/frame.h"
#include "gpu/raster/surfaces_on_device.h"
#include "gpu/shadow_planes/airlight_term.h"
#include "gpu/shadow_planes/edge_fan.h"
#include "gpu/shadow_planes/vertex_airlight.h"

namespace airlight::gpu::shadow_planes {

// Light of all lamps in a picture, in a frame's buffers.
struct LitPicture {
  // Clears the counters. `crossings`: edges are crossed; `dispatches`: of lights and airs, those that go on included.
  LitPicture(Frame&, const scene::View&, bool hits, bool crossings, int dispatches);
  scene::View view;
  const Buffer *distances, *primitives;  // of the first hits; null: there are none
  const Buffer &pixels, &states;         // the layouts of pixels.glsl, state.glsl
  Buffer& counters;                      // the layout of counters.glsl
  int next_groups = 1;                   // index of the first of resume_groups that no dispatch writes yet
  bool empty = true;                     // nothing is in the pixels yet
};

class PlaneShading {
 public:
  // Uploads materials. `surfaces` is null where there are none, nor balls of lights; all must live on. The pointer may
  // come to point to the same scene with other lights.
  PlaneShading(Context&, const std::shared_ptr<const scene::Scene>&, const airlight::shadow_planes::Options&,
               const AirlightTermsOnDevice&, const SurfacesOnDevice* surfaces);

  // Edges of one light whose planes rays may cross: null where nothing casts a shadow.
  struct Edges {
    const LightEdges* edges = nullptr;
    const FanOnDevice* fan = nullptr;
  };
  // Adds an air (-1: there is none) as a light shows it, and with the first of them what surfaces reflect of the light.
  // `values` is null where the airlight is computed for every pixel. `rounds`: dispatches that go on with pixels that
  // have more crossings than the first gathers; they cost next to nothing where no pixel has.
  void add(LitPicture&, int light, int term, const Edges&, const VertexValues*, int rounds) const;

  // Crossings of a pixel that a dispatch takes in.
  int crossings_of_dispatch() const { return most_hits * most_gatherings_; }

  // Into the frame's layers; with the ambient term where there is one.
  void compose(const LitPicture&, Frame&, const std::optional<Rgb>& ambient) const;

 private:
  Program& shade_program(int light, int term, const LitPicture&, bool crossings, bool values) const;
  void leave_out(const LightEdges&, const Box&, const Point3& light) const;
  bool in_stages(int term, const Edges&, const VertexValues*) const;

  Context& context_;
  const std::shared_ptr<const scene::Scene>& scene_;
  airlight::shadow_planes::Options options_;
  const AirlightTermsOnDevice& airlight_terms_;
  const SurfacesOnDevice* surfaces_;
  bool spheres_;  // among surfaces
  int most_gatherings_;
  Buffer materials_, tables_;
  Program &left_out_, &composition_;
  mutable std::map<std::array<int, 5>, Program*> programs_;
};

}  // namespace airlight::gpu::shadow_planes
