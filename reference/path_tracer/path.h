// One random walk from the eye: the estimators of the references' specification, section 3.
//
// Collisions by delta tracking. At every vertex one light is sampled (next-event estimation); the environment is
// combined with the continuation of the walk, and a point light that is close to a medium with a "connection": a
// second ray from the vertex, towards the light more often than not, on which a point is drawn with equal angles as the
// light sees them. Combinations weight by the balance heuristic with the true densities, transmittances included.
//
// Coloured extinction: the walk follows the extinction of one channel, drawn uniformly; every channel is weighted by
// the mean of the densities with which the three would have made the path (spectral multiple importance sampling,
// balance heuristic; Wilkie et al. 2014).
#pragma once
#include <memory>

#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/lights.h"
#include "reference/path_tracer/media.h"
#include "reference/path_tracer/options.h"
#include "reference/path_tracer/path_sample.h"
#include "scene/scene.h"

namespace airlight::path_tracer {

// Everything of a scene that paths need, prepared once.
class World {
 public:
  World(std::shared_ptr<const scene::Scene>, const Options&);

  const scene::Scene& scene() const { return *scene_; }
  const Options& options() const { return options_; }
  const Media& media() const { return media_; }
  const Lights& lights() const { return lights_; }

  // Is nothing in the way from x to direction w before tmax? Surfaces, and balls of lights but `except`.
  bool visible(const Ray&, double tmax, int except) const;

 private:
  std::shared_ptr<const scene::Scene> scene_;
  Options options_;
  Media media_;
  Lights lights_;
};

// What is the same for every path along one camera ray: computed once for a pixel's centre.
struct CameraRay {
  Ray ray;
  scene::RayEnd end;
  Interval hull;   // where media are
  Rgb background;  // radiance seen through the medium, where the ray ends nowhere
};
CameraRay prepare_camera_ray(const World&, const Ray&, Counters&);

// The radiance of one path along the ray.
void trace(const World&, const CameraRay&, const SampleRandom&, PathSample&, Counters&);

}  // namespace airlight::path_tracer
