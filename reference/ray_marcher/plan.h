// What is prepared once for a scene: layers, the list of lights that each shine from one direction, and options.
#pragma once
#include <memory>
#include <vector>

#include "reference/ray_marcher/layer.h"
#include "reference/ray_marcher/options.h"
#include "reference/ray_marcher/spacing.h"
#include "scene/scene.h"

namespace airlight::ray_marcher {

struct Plan {
  std::shared_ptr<const scene::Scene> scene;
  Options options;
  std::vector<Layer> layers;
  std::vector<scene::Light> lights;  // delta lights only: an environment is replaced by directional lights
};

Plan make_plan(std::shared_ptr<const scene::Scene>, const Options&);

// `count` directional lights that stand for an environment: direction k is the environment's own sample for the k-th
// point of a Fibonacci lattice in the unit square, with irradiance radiance / (pdf * count). For a map that follows its
// luminance, mixed with 5 % uniform; for a constant it is the spherical Fibonacci set. Directions without radiance are
// left out.
std::vector<scene::DirectionalLight> environment_as_lights(const scene::EnvironmentLight&, int count);

// What the environments send along a camera ray that meets nothing [W/m^2/sr].
Rgb background(const scene::Scene&, const Vec3& direction);

// The steps of one camera ray: `common` serves the lights in `lights`, and the transmittance; each light that grades
// the ray around itself has steps of its own.
struct RaySteps {
  struct Pass {
    Spacing spacing;
    std::vector<int> lights;  // indices into Plan::lights
  };
  std::vector<Pass> passes;  // passes[0] is the common one
};
RaySteps ray_steps(const Plan&, const Ray&, double t_end);

struct Counters {
  long long rays = 0;            // camera rays
  long long steps = 0;           // density evaluations on camera rays
  long long shadow_rays = 0;     // from a step or a surface point towards a light, through media
  long long shadow_steps = 0;    // density evaluations on shadow rays
  long long occlusion_rays = 0;  // shadow rays tested against surfaces
  void add(const Counters&);
};

}  // namespace airlight::ray_marcher
