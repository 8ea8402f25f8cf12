// Values that are prepared once for a scene: layers, the list of lights that each shine from one
// direction, and options.
#pragma once
#include <memory>
#include <vector>

#include "reference/light_map/light_map.h"
#include "reference/ray_marcher/layer.h"
#include "reference/ray_marcher/options.h"
#include "reference/ray_marcher/spacing.h"
#include "scene/light/sky_directions.h"

namespace airlight::ray_marcher {

struct Plan {
  std::shared_ptr<const scene::Scene> scene;
  Options options;
  std::vector<Layer> layers;
  std::vector<scene::Light> lights;  // delta lights only: an environment is replaced by directional lights
  bool swallowed = false;  // fog without end takes all light from infinitely far away: such lights are left out
  bool scatters = false;   // some medium has an albedo, and there is light for it
  std::vector<std::shared_ptr<const light_map::LightMap>> maps;  // of make_light_maps, one for each light
  double map_seconds = 0;                                        // what they took
  int maps_made = 0;                                             // those shared with a frame before left out
};

// Size of the finest voxels [m], the unit of the settings `step` and `shadow_step`; 1 without a grid.
double length_unit(const scene::Scene&);

// Kernels compute places within media in float: is that too coarse for this scene?
bool too_fine_for_kernels(const scene::Scene&);

// Without maps, which are made by make_light_maps (light_maps.h) or on a device. `before`: of the frame before, whose layers are shared where
// they still hold; may be null.
Plan make_plan(std::shared_ptr<const scene::Scene>, const Options&, const Plan* before = nullptr);

// One march along a camera ray. The first of a ray is common: it serves the transmittance, and every light that has no
// march of its own. A light that grades the ray around itself has one.
struct Pass {
  int ray;
  int own_light;  // -1: common
  Spacing spacing;
};
// Appends the passes of a ray, and their steps.
void add_passes(const Plan&, int ray_number, const Ray&, double t_end, std::vector<Pass>&, std::vector<Step>&);
// Is that pass the one for this light?
bool serves(const std::vector<Pass>&, std::size_t pass, int light);

// Work done, and where the time went (summed over threads).
struct Counters {
  long long rays = 0;            // camera rays
  long long steps = 0;           // density evaluations on camera rays
  long long shadow_rays = 0;     // from a step or a surface point towards a light, through media
  long long shadow_steps = 0;    // density evaluations on shadow rays
  long long look_ups = 0;        // in maps of lights, instead of shadow rays
  long long occlusion_rays = 0;  // shadow rays tested against surfaces
  double ray_seconds = 0, march_seconds = 0, occlusion_seconds = 0, shadow_seconds = 0, scattering_seconds = 0,
         surface_seconds = 0;
  void operator+=(const Counters&);
};

}  // namespace airlight::ray_marcher
