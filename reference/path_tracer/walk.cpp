#include "reference/path_tracer/walk.h"

#include <algorithm>
#include <optional>

#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/surface_sampling.h"
#include "scene/base/error.h"

namespace airlight::path_tracer {

const Flight Walk::analog_;

// The vertex at which ray_ arrives.
Vertex Walk::next_vertex() {
  if (++vertex_ >> branch_shift)
    throw Error("path_tracer: a path has 2^24 vertices; set max_order, or absorb light somewhere");
  Vertex v;
  v.w = ray_.direction;
  return v;
}

// Roulette, the connections of a vertex, and the direction in which the walk goes on.
bool Walk::leave(const Vertex& v) {
  const RandomBlock scatter = block(Purpose::scatter);
  if (!survive(scatter.coarse(3))) return false;
  if (lights_.any_connected() && may_scatter(v.hit != nullptr)) connect_from(v);
  Vec3 out;
  if (v.hit) {
    const scene::Material& material = world_.scene().surfaces[v.hit->surface].material;
    out = sample_reflection(material, v.hit->normal, -v.w, block(Purpose::scatter, 1).coarse(0), scatter.fine(0),
                            scatter.coarse(2));
    const Rgb value = scatter_value(v, out);
    direction_pdf_ = scatter_pdf(v, out);
    if (!(direction_pdf_ > 0)) return false;
    throughput_ *= value / direction_pdf_;
    if (!(throughput_.maxCoeff() > 0)) return false;
    ++s_;
  } else {
    const scene::PhaseFunction& phase = media_.tracked()[v.medium].medium->phase;
    const double c = scene::sample_phase_cosine(phase, scatter.fine(0));
    out = turned(v.w, c, scatter.coarse(2));
    direction_pdf_ = scene::phase_value(phase, c);
  }
  ray_ = {origin(v, out), out};
  return true;
}

bool Walk::collide(const Collision& collision) {
  const bool grey = media_.grey();
  const scene::Medium& medium = *media_.tracked()[collision.medium].medium;
  // How the segment changes the densities of the channels; the transmittance is needed where they differ, and for
  // weights.
  const bool need_T = !grey || (exact() && lights_.any_connected());
  const Rgb T = need_T ? media_.transmittance(ray_, collision.t, counters_) : Rgb(Rgb::Ones());
  const Rgb factor = T * medium.sigma_t * collision.density;
  const Rgb arriving = density_ * factor * flight_->gain;  // unnormalised
  const double mean = arriving.mean();
  if (!(mean > 0)) return false;  // underflow: optical depths beyond 700
  const double forced = grey ? 1 / flight_->gain[0] : (density_ * factor).mean() / mean;
  scale_ *= forced;
  if (grey) {
    throughput_ *= forced;
  } else {
    throughput_ *= factor / mean;
    density_ = arriving / mean;
  }
  if (!may_scatter()) {
    sample_.truncated += throughput_ * medium.albedo;
    return false;
  }
  Vertex v = next_vertex();
  v.x = ray_.at(collision.t);
  v.medium = collision.medium;
  throughput_ *= medium.albedo;
  ++m_;
  if (!(throughput_.maxCoeff() > 0)) return false;
  gather(v, (vertex_ == 1 ? 1.0 : direction_pdf_) * arriving);
  return leave(v);
}

// What is at the end of the segment: nothing, or a surface.
bool Walk::reflect(const scene::RayEnd& end) {
  if (end.on_ball || (m_ == 0 && world_.options().paths == Options::Paths::scattered)) return false;
  if (!end.hit) {
    escape(ray_);
    return false;
  }
  if (!may_reflect()) return false;
  Vertex v = next_vertex();
  v.x = end.hit->position;
  v.hit = &*end.hit;
  gather(v, Rgb::Zero());
  return leave(v);
}

// How the walk passes a segment that begins at a vertex. Only what has not scattered yet splits, so that the branches
// of a path are no more than its reflections.
Flight Walk::flight_on(const Ray& ray, const scene::RayEnd& end, Interval hull) const {
  const Options& options = world_.options();
  if (hull.empty() || !may_scatter() || !options.forced || !exact()) return {};
  if (options.only_lit_surfaces()) return force(media_, ray, end.t, infinity, counters_);
  if (world_.boost() == 1 || (m_ > 0 && end.hit)) return {};
  return force(media_, ray, end.t, world_.boost(), counters_);
}

// Makes the segment ready along which ray_ points.
scene::RayEnd Walk::aim() {
  const scene::RayEnd end = scene::ray_end(world_.scene(), ray_);
  hull_ = media_.hull(ray_, end.t);
  flight_ = &analog_;
  if (world_.boost() > 1) {
    own_ = flight_on(ray_, end, hull_);
    flight_ = &own_;
  }
  return end;
}

std::optional<Collision> Walk::fly(double tmax) const {
  std::optional<Collision> collision;
  for (int k = 0; k < flight_->tries && !collision; ++k)
    collision = media_.fly(ray_, tmax, hero_, random_, dimension(), k, flight_->some[hero_], counters_);
  return collision;
}

// A collision or else the segment's end.
bool Walk::pass(const scene::RayEnd& end) {
  if (!hull_.empty()) {
    if (const std::optional<Collision> collision = fly(end.t)) return collide(*collision);
    if (!media_.grey()) {
      const Rgb T = media_.transmittance(ray_, end.t, counters_);
      const Rgb arriving = density_ * T;  // unnormalised
      if (!(arriving.mean() > 0)) return false;
      throughput_ *= T / arriving.mean();
      density_ = arriving / arriving.mean();
    }
  }
  return reflect(end);
}

// The segment's end and, as often as the flight says, a collision.
bool Walk::pass_forced(const scene::RayEnd& end) {
  const double chance = flight_->chance[hero_];
  const bool tried = chance == 1 || block(Purpose::camera, 2).fine(0) < chance;
  const std::optional<Collision> collision = tried ? fly(end.t) : std::nullopt;
  if (collision && end.hit) {
    Walk scattered(*this);
    scattered.branch_ = 1 + vertex_ % 15;
    if (scattered.collide(*collision)) scattered.follow(scattered.aim());
  }
  if (end.hit) {
    throughput_ *= flight_->transmittance;
    return reflect(end);
  }
  if (vertex_ > 0) {  // the camera's background was added before
    const Rgb before = throughput_;
    throughput_ *= flight_->transmittance;
    reflect(end);
    throughput_ = before;
  }
  return collision && collide(*collision);
}

void Walk::follow(const scene::RayEnd& first) {
  scene::RayEnd later;
  const scene::RayEnd* end = &first;
  for (;;) {
    ++counters_.rays;
    if (!(flight_->forced ? pass_forced(*end) : pass(*end))) return;
    later = aim();
    end = &later;
  }
}

void Walk::run(const CameraRay& camera) {
  const RandomBlock first = block(Purpose::camera, 1);
  if (!media_.grey()) hero_ = std::min(2, int(3 * first.coarse(0)));
  ray_ = camera.ray;
  hull_ = camera.hull;
  flight_ = &camera.flight;
  if (!camera.end.hit && world_.options().paths == Options::Paths::all) sample_.add(0, 0, camera.background);
  if (lights_.any_connected() && !hull_.empty() && may_scatter()) {
    const Pick pick = lights_.pick_for_ray(ray_, hull_, first.coarse(1));
    if (pick.light >= 0)
      connect(ray_, hull_, throughput_, pick, 1.0, flight_->gain, true, 0, block(Purpose::connection).fine(0));
  }
  follow(camera.end);
}

}  // namespace airlight::path_tracer
