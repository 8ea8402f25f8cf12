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
  if (camera.end.t == infinity && !world.lights().environments().empty()) {
    Rgb radiance = Rgb::Zero();
    for (const int i : world.lights().environments())
      radiance += scene::radiance(std::get<scene::EnvironmentLight>(world.lights().light(i)), ray.direction);
    camera.background =
        camera.hull.empty() ? radiance : Rgb(radiance * world.media().transmittance(ray, infinity, counters));
  }
  return camera;
}

}  // namespace airlight::path_tracer
