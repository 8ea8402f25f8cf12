// A plan of the ray marcher on the device: what its shaders read, and their dispatches.
#pragma once
#include <vector>

#include "gpu/environment_lights.h"
#include "gpu/frame.h"
#include "gpu/material_tables.h"
#include "gpu/raster/first_hits.h"
#include "gpu/ray_marcher/grid_field.h"
#include "gpu/ray_marcher/rounds.h"
#include "reference/ray_marcher/plan.h"
#include "scene/renderer.h"

namespace airlight::gpu::ray_marcher {

// Layers of a film on the device, 3 floats a pixel, and what ends its rays. Null: nothing does.
struct MarchedFilm {
  const Buffer *distances = nullptr, *primitives = nullptr;
  const Buffer* seen = nullptr;  // what backdrops send (gpu/raster/backdrops.h)
  const Buffer &airlight, &transmittance, &surface, &mean;
  const Buffer& totals;  // low and high words of steps, shadow rays, shadow steps, occlusion rays
};

class PlanOnDevice {
 public:
  // Uploads; keeps the plan and the surfaces by reference (null: there are none, nor balls of lights). Throws
  // Unavailable where the device has no room for a grid.
  PlanOnDevice(Context&, const airlight::ray_marcher::Plan&, GridStorage, const FirstHits*);

  const GridsOnDevice& grids() const { return grids_; }

  // Media, surfaces, environment and composition, the stages of frame.timer, in bands of the image whose state fits into
  // a buffer. `counts`: the totals are wanted. `looks` as in Rounds. Throws scene::Interrupted if `progress` says so.
  void render(const scene::View&, const MarchedFilm&, Frame&, bool counts, bool looks,
              const std::function<bool(double)>& progress);
  // Rounds::note and Rounds::unfinished of all that takes several.
  void note(Download&) const;
  bool unfinished(const Download&) const;

 private:
  PlanOnDevice(Context&, const airlight::ray_marcher::Plan&, GridStorage, const FirstHits*, const MaterialTables&);
  struct Band {
    int first_row, rows;
    const Buffer& pixels;
  };
  void bind(Program&) const;
  void march(const scene::View&, const MarchedFilm&, FrameBuffers&, const Band&);
  void reflect(const scene::View&, const MarchedFilm&, FrameBuffers&, const Band&);
  void add_environments(const scene::View&, const MarchedFilm&, const Band&);
  void compose(const scene::View&, const MarchedFilm&, const Band&, bool counts);

  Context& context_;
  const airlight::ray_marcher::Plan& plan_;
  const FirstHits* first_hits_;
  Point3 middle_;  // of the scene: positions on the device are relative to it
  int balls_;      // point and spot lights
  bool has_occluders_, reflects_;
  double magnitude_ = 0;  // largest coordinate of what is seen [m]
  GridsOnDevice grids_;
  Buffer layers_, gaussians_, bricks_, lights_, solids_, materials_, reflectances_;
  EnvironmentLights environments_;
  Program *march_ = nullptr, *surfaces_ = nullptr, *composition_ = nullptr;  // null: left out
  std::vector<Program*> backgrounds_;                                        // by environment
  Rounds march_rounds_, surface_rounds_;
};

}  // namespace airlight::gpu::ray_marcher
