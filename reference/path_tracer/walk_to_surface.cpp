#include <algorithm>
#include <optional>

#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/surface_sampling.h"
#include "reference/path_tracer/walk.h"

namespace airlight::path_tracer {

// Environments along ray_, which ends there, with its exact transmittance.
void Walk::escape_unscattered(const scene::RayEnd& end) {
  if (lights_.environments().empty() || end.hit || end.on_ball) return;
  const Rgb before = throughput_;
  throughput_ *= media_.transmittance(ray_, end.t, counters_);
  escape(ray_);
  throughput_ = before;
}

// From the eye to a surface without a collision, with the exact transmittance; from there at most one scattering, made
// by the connection and by the walk's own flight, weighted as everywhere.
void Walk::run_to_surface(const CameraRay& camera) {
  const Options& options = world_.options();
  if (!camera.end.hit) return;
  if (!media_.grey()) hero_ = std::min(2, int(3 * block(Purpose::camera, 1).coarse(0)));
  ++counters_.rays;
  if (!camera.hull.empty()) throughput_ *= media_.transmittance(camera.ray, camera.end.t, counters_);
  vertex_ = 1;
  Vertex v;
  v.w = camera.ray.direction;
  v.x = camera.end.hit->position;
  v.hit = &*camera.end.hit;
  if (options.paths == Options::Paths::lit_surface) gather(v, Rgb::Zero());
  if (lights_.any_connected() && options.max_order != 0) connect_from(v);

  const RandomBlock scatter = block(Purpose::scatter);
  const scene::Material& material = world_.scene().surfaces[v.hit->surface].material;
  const Vec3 out = sample_reflection(material, v.hit->normal, -v.w, block(Purpose::scatter, 1).coarse(0),
                                     scatter.fine(0), scatter.coarse(2));
  const Rgb value = scatter_value(v, out);
  direction_pdf_ = scatter_pdf(v, out);
  if (!(direction_pdf_ > 0) || !(value.maxCoeff() > 0)) return;
  throughput_ *= value / direction_pdf_;
  ++s_;
  ray_ = {origin(v, out), out};
  const scene::RayEnd end = scene::ray_end(world_.scene(), ray_);
  hull_ = media_.hull(ray_, end.t);
  own_ = flight_on(ray_, end, hull_);
  flight_ = &own_;
  if (options.paths == Options::Paths::lit_surface) escape_unscattered(end);
  if (hull_.empty() || options.max_order == 0) return;
  ++counters_.rays;
  const std::optional<Collision> collision = fly(end.t);
  if (!collision) return;
  const scene::Medium& medium = *media_.tracked()[collision->medium].medium;
  const Rgb T = exact() ? media_.transmittance(ray_, collision->t, counters_) : Rgb(Rgb::Ones());
  const Rgb factor = T * medium.sigma_t * collision->density, arriving = factor * flight_->gain;
  if (!(arriving.mean() > 0)) return;
  throughput_ *= factor / arriving.mean() * medium.albedo;
  ++vertex_;
  Vertex there;
  there.w = ray_.direction;
  there.x = ray_.at(collision->t);
  there.medium = collision->medium;
  ++m_;
  gather(there, direction_pdf_ * arriving);
  if (lights_.environments().empty()) return;
  const RandomBlock again = block(Purpose::scatter);
  const double c = scene::sample_phase_cosine(medium.phase, again.fine(0));
  const Vec3 turned_out = turned(there.w, c, again.coarse(2));
  direction_pdf_ = scene::phase_value(medium.phase, c);
  ray_ = {there.x, turned_out};
  escape_unscattered(scene::ray_end(world_.scene(), ray_));
}

}  // namespace airlight::path_tracer
