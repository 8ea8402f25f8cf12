#include <cmath>

#include "scene/scene.h"

namespace airlight::scene {
namespace {

// Where a ray that starts outside first meets a ball; infinity if it does not. A ray that starts inside sees no ball:
// nothing would be left to see.
double ball_distance(const LightBall& ball, const Ray& ray) {
  const Vec3 offset = ball.center - ray.origin;
  const double along = offset.dot(ray.direction);
  if (along <= 0) return infinity;
  // The distance of the line from the centre by its perpendicular, not by |offset|^2 - along^2, which cancels.
  const double half_chord_squared = ball.radius * ball.radius - (offset - along * ray.direction).squaredNorm();
  if (half_chord_squared <= 0) return infinity;
  const double t = along - std::sqrt(half_chord_squared);
  return t > 0 ? t : infinity;
}

}  // namespace

RayEnd ray_end(const Scene& scene, const Ray& ray) {
  RayEnd end;
  if (scene.geometry) {
    end.hit = scene.geometry->first_hit(ray);
    if (end.hit) end.t = end.hit->t;
  }
  for (const Light& light : scene.lights) {
    const auto sphere = ball(light);
    if (!sphere || sphere->radius <= 0) continue;
    const double t = ball_distance(*sphere, ray);
    if (t < end.t) end = {t, std::nullopt, true, std::nullopt};
  }
  return end;
}

RayEnd camera_end(const Scene& scene, const Ray& ray) {
  RayEnd end = ray_end(scene, ray);
  for (const auto& backdrop : scene.backdrops)
    if (const auto point = seen_along(*backdrop, scene.camera, ray))
      if (point->t < end.t || (point->t == infinity && end.t == infinity && !end.seen))
        end = {point->t, std::nullopt, false, point->radiance};
  return end;
}

}  // namespace airlight::scene
