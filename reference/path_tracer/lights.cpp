#include "reference/path_tracer/lights.h"

#include <algorithm>
#include <cmath>

#include "reference/path_tracer/sampling.h"

namespace airlight::path_tracer {
namespace {

// A mean of the channels, so that a light of any colour has a positive strength.
double strength(const Rgb& colour) { return colour.abs().mean(); }

double distance_to(const Box& box, const Point3& x) { return (box.lo - x).cwiseMax(x - box.hi).cwiseMax(0).norm(); }

// Draws i with probability weight(i) / sum for the candidates; the second pass stops where the running sum passes u.
template <class Candidates, class Weight>
Pick draw(const Candidates& candidates, double u, Weight weight) {
  double sum = 0;
  for (const int i : candidates) sum += weight(i);
  if (!(sum > 0)) return {};
  Pick pick;
  double running = 0;
  for (const int i : candidates) {
    const double w = weight(i);
    if (!(w > 0)) continue;
    pick = {i, w / sum};
    running += w;
    if (u * sum < running) break;
  }
  return pick;
}

template <class Candidates, class Weight>
double share(const Candidates& candidates, int light, Weight weight) {
  double sum = 0;
  for (const int i : candidates) sum += weight(i);
  return sum > 0 ? weight(light) / sum : 0;
}

struct Range {
  int n;
  struct It {
    int i;
    int operator*() const { return i; }
    void operator++() { ++i; }
    bool operator!=(const It& o) const { return i != o.i; }
  };
  It begin() const { return {0}; }
  It end() const { return {n}; }
};

}  // namespace

Lights::Lights(const scene::Scene& scene, const Options& options) : lights_(&scene.lights) {
  const int n = int(scene.lights.size());
  is_connected_.assign(n, 0);
  has_position_.assign(n, 0);
  strength_.assign(n, 0);
  position_.assign(n, Point3::Zero());
  Box lit;  // around everything that light is picked for
  for (const scene::Medium& medium : scene.media) {
    const Box box = scene::bounding_box(medium);
    if (!box.empty() && (box.size().array() < infinity).all()) lit = unite(lit, box);
  }
  for (int i = 0; i < n; ++i) {
    const scene::Light& light = scene.lights[i];
    if (const auto ball = scene::ball(light)) {
      has_position_[i] = 1;
      position_[i] = ball->center;
      const auto* spot = std::get_if<scene::SpotLight>(&light);
      strength_[i] = strength(spot ? spot->intensity : std::get<scene::PointLight>(light).intensity);
      // Next-event estimation at analog vertices has an infinite variance inside a medium, and a large one close to it:
      // E[1/d^4]. From a quarter of a medium's diagonal on it is finite and small, and a connection gains nothing.
      bool close = false;
      for (const scene::Medium& medium : scene.media) {
        const Box box = scene::bounding_box(medium);
        if (box.empty()) continue;
        const double diagonal = box.size().norm();
        close = close || !(diagonal < infinity) || distance_to(box, ball->center) < 0.25 * diagonal;
      }
      using Connection = Options::Connection;
      is_connected_[i] = strength_[i] > 0 && (options.connection == Connection::always ||
                                              (options.connection == Connection::automatic && close));
      if (is_connected_[i]) connected_.push_back(i);
      lit = unite(lit, Box{ball->center, ball->center});
    } else if (const auto* sun = std::get_if<scene::DirectionalLight>(&light)) {
      strength_[i] = strength(sun->irradiance);
    } else {
      const auto& environment = std::get<scene::EnvironmentLight>(light);
      strength_[i] = std::abs(scene::environment_power(environment));
      // A map of harmonics may be dark on the whole and not in its parts.
      for (const Rgb& c : environment.sh) strength_[i] = std::max(strength_[i], strength(c * environment.scale));
      environments_.push_back(i);
    }
    any_ = any_ || strength_[i] > 0;
  }
  if (!lit.empty()) least_distance_ = 1e-3 * lit.size().norm();
}

double Lights::weight(int i, const Point3& x) const {
  if (!has_position_[i]) return strength_[i];
  const double d2 = (position_[i] - x).squaredNorm();
  return strength_[i] / std::max(d2, std::max(least_distance_ * least_distance_, 1e-300));
}
double Lights::connection_weight(int i, const Point3& x) const {
  return strength_[i] / std::max((position_[i] - x).norm(), std::max(least_distance_, 1e-150));
}
double Lights::ray_weight(int i, const Ray& ray, Interval t) const {
  const Equiangular angles(ray, position_[i], t);
  return angles.usable() ? strength_[i] * angles.span / std::max(angles.h, std::max(1e-3 * least_distance_, 1e-150))
                         : 0;
}

Pick Lights::pick(const Point3& x, double u) const {
  const int n = int(strength_.size());
  if (n == 1) return {strength_[0] > 0 ? 0 : -1, 1.0};
  return draw(Range{n}, u, [&](int i) { return weight(i, x); });
}
double Lights::probability(int light, const Point3& x) const {
  const int n = int(strength_.size());
  if (n == 1) return 1;
  return share(Range{n}, light, [&](int i) { return weight(i, x); });
}
Pick Lights::pick_for_ray(const Ray& ray, Interval t, double u) const {
  if (connected_.size() == 1) return {connected_[0], 1.0};
  return draw(connected_, u, [&](int i) { return ray_weight(i, ray, t); });
}
double Lights::probability_for_ray(int light, const Ray& ray, Interval t) const {
  if (connected_.size() == 1) return 1;
  return share(connected_, light, [&](int i) { return ray_weight(i, ray, t); });
}
Pick Lights::pick_for_connection(const Point3& x, double u) const {
  if (connected_.size() == 1) return {connected_[0], 1.0};
  return draw(connected_, u, [&](int i) { return connection_weight(i, x); });
}
double Lights::probability_for_connection(int light, const Point3& x) const {
  if (connected_.size() == 1) return 1;
  return share(connected_, light, [&](int i) { return connection_weight(i, x); });
}

}  // namespace airlight::path_tracer
