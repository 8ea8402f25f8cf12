// Chooses a light to sample: in proportion to the light that it would send to a point in vacuum, with a positive
// probability for every light that can contribute.
#pragma once
#include <vector>

#include "reference/path_tracer/options.h"
#include "scene/scene.h"

namespace airlight::path_tracer {

struct Pick {
  int light = -1;  // index into the scene's lights; -1: none
  double probability = 0;
};

class Lights {
 public:
  Lights(const scene::Scene&, const Options&);

  bool any() const { return any_; }
  const scene::Light& light(int i) const { return (*lights_)[i]; }
  const std::vector<int>& environments() const { return environments_; }

  // For next-event estimation at x: all lights.
  Pick pick(const Point3& x, double u) const;
  double probability(int light, const Point3& x) const;

  // Lights that need the bounded connection: those close to a medium. `connected(i)` says whether light i is one.
  bool any_connected() const { return !connected_.empty(); }
  bool connected(int light) const { return is_connected_[light]; }
  // For a connection along a ray whose direction was not drawn (the camera's): by the single scattering of a uniform
  // medium along it, intensity * angle / distance of the ray.
  Pick pick_for_ray(const Ray&, Interval, double u) const;
  double probability_for_ray(int light, const Ray&, Interval) const;
  // For a connection in a random direction from x: intensity / distance, the same averaged over directions.
  Pick pick_for_connection(const Point3& x, double u) const;
  double probability_for_connection(int light, const Point3& x) const;

 private:
  double weight(int light, const Point3& x) const;
  double ray_weight(int light, const Ray&, Interval) const;
  double connection_weight(int light, const Point3& x) const;

  const std::vector<scene::Light>* lights_;
  std::vector<int> environments_, connected_;
  std::vector<char> is_connected_;
  std::vector<double> strength_;  // luminance of intensity, irradiance, or integral of the radiance
  std::vector<Point3> position_;  // of point and spot lights
  std::vector<char> has_position_;
  double least_distance_ = 0;  // [m]: closer, a light's weight grows no more
  bool any_ = false;
};

}  // namespace airlight::path_tracer
