#include "reference/path_tracer/world.h"

#include <cmath>

namespace airlight::path_tracer {

World::World(std::shared_ptr<const scene::Scene> scene, const Options& options)
    : scene_(std::move(scene)), options_(options), media_(scene_->media, options), lights_(*scene_, options) {}

bool World::visible(const Ray& ray, double tmax, int except) const {
  if (scene_->geometry && scene_->geometry->occluded(ray, tmax)) return false;
  for (int i = 0; i < int(scene_->lights.size()); ++i) {
    if (i == except) continue;
    const auto ball = scene::ball(scene_->lights[i]);
    if (!ball || !(ball->radius > 0)) continue;
    const Vec3 offset = ball->center - ray.origin;
    const double along = offset.dot(ray.direction);
    const double half_squared = ball->radius * ball->radius - (offset - along * ray.direction).squaredNorm();
    if (along <= 0 || half_squared <= 0) continue;
    const double t = along - std::sqrt(half_squared);
    if (t > 0 && t < tmax) return false;
  }
  return true;
}

CameraRay prepare_camera_ray(const World& world, const Ray& ray, Counters& counters) {
  CameraRay camera{ray, scene::ray_end(world.scene(), ray), {}, Rgb::Zero()};
  camera.hull = world.media().hull(ray, camera.end.t);
  if (camera.end.hit) return camera;
  const Options& options = world.options();
  const bool sees = camera.end.t == infinity && !world.lights().environments().empty();
  // Measured: twice as good and more under an environment, whose background is then free of noise and no longer makes
  // up for collisions that did not happen; not worth the flights in a medium that varies under other lights.
  const bool forces =
      options.forced && options.column_transmittance && options.max_order != 0 && (sees || world.media().homogeneous());
  Rgb depth = Rgb::Zero();
  if (!camera.hull.empty() && (sees || forces)) depth = world.media().optical_depth(ray, camera.end.t, counters);
  const Rgb T = world.media().transmittance(depth);
  if (forces) {
    // As many as leave 3 % of no collision at all; none where there is no medium.
    const double mean = T.mean();
    camera.tries = 0;
    camera.gain = Rgb::Zero();
    Rgb power = Rgb::Ones();
    double missed = 1;
    while ((depth > 0).any() && camera.tries < most_tries && missed > 0.03) {
      camera.gain += power;
      power *= T;
      missed *= mean;
      ++camera.tries;
    }
  }
  if (sees) {
    Rgb radiance = Rgb::Zero();
    for (const int i : world.lights().environments())
      radiance += scene::radiance(std::get<scene::EnvironmentLight>(world.lights().light(i)), ray.direction);
    camera.background = radiance * T;
  }
  return camera;
}

}  // namespace airlight::path_tracer
