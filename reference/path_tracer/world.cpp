#include "reference/path_tracer/world.h"

#include <cmath>

#include "scene/light/background.h"

namespace airlight::path_tracer {

World::World(std::shared_ptr<const scene::Scene> scene, const Options& options)
    : scene_(std::move(scene)), options_(options), media_(scene_->media, options), lights_(*scene_, options) {
  if (options.forced && options.column_transmittance) boost_ = collision_boost(*scene_);
}

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
  CameraRay camera{{ray, scene::camera_end(world.scene(), ray), {}, {}}, Rgb::Zero()};
  auto& [_, end, hull, flight] = camera.segment;
  hull = world.media().hull(ray, end.t);
  const Options& options = world.options();
  const bool sees = end.seen || (end.t == infinity && !world.lights().environments().empty());
  // Measured: worth it under an environment, whose background is then free of noise and no longer makes up for
  // collisions that did not happen, and where flights cost next to nothing. Else, and before a surface, which takes a
  // path more, only in media that hardly any path would meet.
  const bool worth = end.hit ? world.boost() > 1 : sees || world.media().homogeneous() || world.boost() > 1;
  const bool forces = options.forced && options.column_transmittance && options.max_order != 0 && worth;
  if (!hull.empty() && forces) flight = force(world.media(), ray, end.t, end.hit ? world.boost() : infinity, counters);
  if (sees) {
    const bool known = hull.empty() || flight.forced;
    const Rgb T = known ? flight.transmittance : world.media().transmittance(ray, end.t, counters);
    camera.background = background(world.scene(), end, ray.direction) * T;
  }
  return camera;
}

}  // namespace airlight::path_tracer
