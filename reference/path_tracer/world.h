// A scene and a camera ray, each made ready for many paths.
#pragma once
#include <memory>

#include "reference/path_tracer/counters.h"
#include "reference/path_tracer/forcing.h"
#include "reference/path_tracer/lights.h"
#include "reference/path_tracer/media.h"
#include "reference/path_tracer/options.h"
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
  // Factor on the probability of collisions that follow no other collision (see collision_boost). 1
  // where collisions are not forced.
  double boost() const { return boost_; }

  // Is the segment from x in direction w free before tmax? Surfaces block it, and the balls of all
  // lights except `except`.
  bool visible(const Ray&, double tmax, int except) const;

 private:
  std::shared_ptr<const scene::Scene> scene_;
  Options options_;
  Media media_;
  Lights lights_;
  double boost_ = 1;
};

// A part of a path between two of its vertices: from the start of a ray to what it meets.
struct Segment {
  Ray ray;
  scene::RayEnd end;
  Interval hull;  // where media are
  Flight flight;  // how collisions on it are drawn
};

// Values shared by every path along one camera ray: computed once for a pixel's centre.
struct CameraRay {
  Segment segment;
  Rgb background;  // radiance seen through the medium, where no surface ends the ray
};
CameraRay prepare_camera_ray(const World&, const Ray&, Counters&);

}  // namespace airlight::path_tracer
