#include <algorithm>
#include <optional>

#include "reference/path_tracer/walk.h"

namespace airlight::path_tracer {

// Environments along the segment, with its exact transmittance.
void Walk::escape_unscattered(const Path& path) const {
  const Segment& segment = *path.segment;
  if (lights_.environments().empty() || segment.end.hit || segment.end.on_ball) return;
  escape(path, path.throughput * media_.transmittance(segment.ray, segment.end.t, counters_));
}

// From the eye to a surface without a collision, with the exact transmittance; from there at most one scattering, made
// by the connection and by the path's own flight, weighted as everywhere.
void Walk::run_to_surface(const CameraRay& camera) const {
  if (!camera.segment.end.hit) return;
  Path path;
  path.segment = &camera.segment;
  if (!media_.grey()) path.hero = std::min(2, int(3 * block(path, Purpose::camera, 1).coarse(0)));
  ++counters_.rays;
  if (!path.segment->hull.empty())
    path.throughput *= media_.transmittance(path.segment->ray, path.segment->end.t, counters_);

  // The surface: light that reaches it directly, and a direction to go on.
  Vertex v = next_vertex(path, camera.segment.end.hit->position);
  v.hit = &*camera.segment.end.hit;
  if (options_.paths == Options::Paths::lit_surface) next_event(path, v);
  if (lights_.any_connected() && options_.max_order != 0) connect_from(path, v);
  const Vec3 out = draw_direction(path, v, block(path, Purpose::scatter));
  if (!(path.throughput.maxCoeff() > 0)) return;
  const Ray ray{origin(v, out), out};
  Segment next;
  aim(path, ray, next);
  if (options_.paths == Options::Paths::lit_surface) escape_unscattered(path);

  // The collision.
  if (path.segment->hull.empty() || options_.max_order == 0) return;
  ++counters_.rays;
  const std::optional<Collision> collision = fly(path);
  if (!collision) return;
  const scene::Medium& medium = this->medium(collision->medium);
  const Rgb T = exact() ? media_.transmittance(ray, collision->t, counters_) : Rgb(Rgb::Ones());
  const Rgb factor = T * medium.sigma_t * collision->density, arriving = factor * path.segment->flight.gain;
  if (!(arriving.mean() > 0)) return;
  path.throughput *= factor / arriving.mean() * medium.albedo;
  Vertex there = next_vertex(path, ray.at(collision->t));
  there.medium = collision->medium;
  there.analog_pdf = path.direction_pdf * arriving;
  ++path.scatterings;
  next_event(path, there);
  if (lights_.environments().empty()) return;
  next.ray = {there.x, draw_direction(path, there, block(path, Purpose::scatter))};
  next.end = scene::ray_end(world_.scene(), next.ray);
  escape_unscattered(path);
}

}  // namespace airlight::path_tracer
