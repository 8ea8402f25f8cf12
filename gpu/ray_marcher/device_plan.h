// A plan of the ray marcher on the device, and its dispatches.
#pragma once
#include <array>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/raster/occluders.h"
#include "gpu/ray_marcher/grids_on_device.h"
#include "gpu/timer.h"
#include "reference/ray_marcher/plan.h"
#include "scene/renderer.h"

namespace airlight::gpu {

// What the device makes of a pixel; the layout of march.comp.
struct MarchedPixel {
  std::array<float, 3> airlight;  // [W/m^2/sr]
  unsigned steps;
  std::array<float, 3> transmittance;
  unsigned shadow_rays;
  unsigned shadow_steps;
  unsigned occlusion_rays;
  int march, part;
  float step;
  int light;
  float from, width;
};

class PlanOnDevice {
 public:
  // Uploads; keeps the plan by reference. Throws Unavailable where the device has no room for a grid.
  PlanOnDevice(Context&, const ray_marcher::Plan&, GridStorage);

  const GridsOnDevice& grids() const { return grids_; }

  // `distances` end the pixels' rays: floats [m], row 0 first; null where all are infinite. The image is done in
  // dispatches of about a tenth of a second, with progress between them; throws scene::Interrupted if asked to stop.
  // Requires a layer.
  std::vector<MarchedPixel> march(const scene::View&, const Buffer* distances, const scene::Execution&, StageTimer&);

 private:
  Program& program(const scene::View&);

  Context& context_;
  const ray_marcher::Plan& plan_;
  Point3 middle_;  // of the scene: positions on the device are relative to it
  int balls_;      // point and spot lights
  bool has_occluders_;
  Occluders occluders_;
  GridsOnDevice grids_;
  Buffer layers_, gaussians_, bricks_, lights_, nodes_, triangles_, solids_;
};

}  // namespace airlight::gpu
