#include "reference/path_tracer/path.h"

#include <algorithm>

#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/walk.h"
#include "scene/base/error.h"

namespace airlight::path_tracer {

void trace(const World& world, const CameraRay& camera, const SampleRandom& random, PathSample& sample,
           Counters& counters) {
  ++counters.paths;
  const Walk walk(world, random, sample, counters);
  if (world.options().only_lit_surfaces())
    walk.run_to_surface(camera);
  else
    walk.run(camera);
}

// The path from the eye.
void Walk::run(const CameraRay& camera) const {
  Path path;
  path.segment = &camera.segment;
  const RandomBlock first = block(path, Purpose::camera, 1);
  if (!media_.grey()) path.hero = std::min(2, int(3 * first.coarse(0)));
  if (!camera.segment.end.hit && options_.paths == Options::Paths::all) sample_.add(0, 0, camera.background);
  if (lights_.any_connected() && !camera.segment.hull.empty() && may_scatter(path))
    connect_from_eye(path, first.coarse(1));
  follow(path, std::nullopt);
}

// The main loop. A branch of a path begins with its collision.
void Walk::follow(Path& path, std::optional<Collision> collision) const {
  Segment next;
  while (true) {
    // Free flight: to a collision, or else to the end of the segment.
    if (!collision) {
      ++counters_.rays;
      collision = fly(path);
      if (path.segment->flight.forced) {
        split(path, collision);
        if (!collision && !path.segment->end.hit) return;
      } else if (!collision && !attenuate(path)) {
        return;
      }
    }

    // Event: in a medium, or on a surface.
    Vertex v;
    if (!(collision ? collide(path, *collision, v) : meet_surface(path, v))) return;

    // Next-event estimation.
    next_event(path, v);

    // Roulette.
    const RandomBlock random = block(path, Purpose::scatter);
    if (!survive(path, random.coarse(3))) return;

    // Connection: a second ray, on which light of a close lamp is scattered.
    if (lights_.any_connected() && may_scatter(path, v.hit != nullptr)) connect_from(path, v);

    // Phase function or reflection: the direction in which the path goes on.
    const Vec3 out = draw_direction(path, v, random);
    if (!(path.throughput.maxCoeff() > 0)) return;
    aim(path, {origin(v, out), out}, next);
    collision.reset();
  }
}

// The next segment, from the path's vertex, and how it is passed. Most scenes force the camera's flight alone.
void Walk::aim(Path& path, const Ray& ray, Segment& next) const {
  next.ray = ray;
  next.end = scene::ray_end(world_.scene(), ray);
  next.hull = media_.hull(ray, next.end.t);
  if (world_.boost() > 1 || options_.only_lit_surfaces()) next.flight = flight_on(path, ray, next.end, next.hull);
  path.segment = &next;
}

// Only what has not scattered yet splits, so that the branches of a path are no more than its reflections.
Flight Walk::flight_on(const Path& path, const Ray& ray, const scene::RayEnd& end, Interval hull) const {
  const bool always = options_.only_lit_surfaces(), thin = world_.boost() > 1 && !(path.scatterings > 0 && end.hit);
  if (!(always || thin) || hull.empty() || !may_scatter(path) || !options_.forced || !exact()) return {};
  return force(media_, ray, end.t, always ? infinity : world_.boost(), counters_);
}

// The collision on the segment, by delta tracking (Media::fly); as often as a forced flight says.
std::optional<Collision> Walk::fly(const Path& path) const {
  const auto& [ray, end, hull, flight] = *path.segment;
  if (hull.empty()) return {};
  const double probability = flight.flight_probability[path.hero];
  if (probability < 1 && !(block(path, Purpose::camera, 2).fine(0) < probability)) return {};
  std::optional<Collision> collision;
  for (int k = 0; k < flight.tries && !collision; ++k)
    collision =
        media_.fly(ray, end.t, path.hero, random_, path.dimension(), k, flight.any_tentative[path.hero], counters_);
  return collision;
}

// After an analog flight to the segment's end: its transmittance is in the chance to arrive, but for what the channels
// differ by. False where no channel gets through.
bool Walk::attenuate(Path& path) const {
  if (path.segment->hull.empty() || media_.grey()) return true;
  const Rgb T = media_.transmittance(path.segment->ray, path.segment->end.t, counters_);
  const Rgb arriving = path.density * T;  // p_c T_c: densities of the channels, up to a factor
  if (!(arriving.mean() > 0)) return false;
  path.throughput *= T / arriving.mean();
  path.density = arriving / arriving.mean();
  return true;
}

// After a forced flight the path goes on both from the collision and, with the exact transmittance, from the segment's
// end. Before a surface that takes a branch, which is followed to its end here; else the path leaves the scene now and
// goes on from the collision.
void Walk::split(Path& path, std::optional<Collision>& collision) const {
  const Rgb& T = path.segment->flight.transmittance;
  if (path.segment->end.hit) {
    if (collision) {
      Path scattered = path;
      scattered.branch = 1 + path.vertex % 15;  // four bits of the random numbers' place; 0 is the path itself
      follow(scattered, collision);
      collision.reset();
    }
    path.throughput *= T;
  } else if (path.vertex > 0) {  // the camera's background was added before
    escape(path, path.throughput * T);
  }
}

// Goes on to the vertex at which the segment ends.
Vertex Walk::next_vertex(Path& path, const Point3& x) const {
  if (++path.vertex >> Path::branch_shift)
    throw Error("path_tracer: a path has 2^24 vertices; set max_order, or absorb light somewhere");
  Vertex v;
  v.x = x;
  v.w = path.segment->ray.direction;
  return v;
}

// Absorption and scattering at a collision; false where the path ends there.
bool Walk::collide(Path& path, const Collision& collision, Vertex& v) const {
  const bool grey = media_.grey();
  const Segment& segment = *path.segment;
  const scene::Medium& medium = this->medium(collision.medium);
  // How the segment changes the densities of the channels; the transmittance is needed where they differ, and for
  // weights.
  const bool need_T = !grey || (exact() && lights_.any_connected());
  const Rgb T = need_T ? media_.transmittance(segment.ray, collision.t, counters_) : Rgb(Rgb::Ones());
  const Rgb factor = T * medium.sigma_t * collision.density;
  // p_c T_c sigma_c density gain_c: densities of the channels, up to a factor. The throughput is multiplied by what the flight has over their
  // mean; in grey scenes by 1 / gain.
  const Rgb arriving = path.density * factor * segment.flight.gain;
  const double mean = arriving.mean();
  if (!(mean > 0)) return false;  // underflow: optical depths beyond 700
  const double forced = grey ? 1 / segment.flight.gain[0] : (path.density * factor).mean() / mean;
  path.forced *= forced;
  if (grey) {
    path.throughput *= forced;
  } else {
    path.throughput *= factor / mean;
    path.density = arriving / mean;
  }
  if (!may_scatter(path)) {
    sample_.truncated += path.throughput * medium.albedo;
    return false;
  }
  v = next_vertex(path, segment.ray.at(collision.t));
  v.medium = collision.medium;
  v.analog_pdf = path.direction_pdf * arriving;
  path.throughput *= medium.albedo;
  ++path.scatterings;
  return path.throughput.maxCoeff() > 0;
}

// Continues at the end of the segment: true on a surface where the path goes on; a path that meets
// nothing leaves the scene.
bool Walk::meet_surface(Path& path, Vertex& v) const {
  const scene::RayEnd& end = path.segment->end;
  if (ends_unseen(path)) return false;
  if (!end.hit) {
    escape(path, path.throughput);
    return false;
  }
  if (!may_go_on(path)) return false;
  v = next_vertex(path, end.hit->position);
  v.hit = &*end.hit;
  return true;
}

bool Walk::survive(Path& path, double u) const {
  if (path.scatterings + path.reflections < options_.roulette_order) return true;
  const double q = std::min(options_.roulette_cap, path.throughput.maxCoeff() / path.forced);  // thinness ends no path
  if (q >= 1) return true;
  if (!(u < q)) return false;
  path.throughput /= q;
  return true;
}

// The throughput is zero where a reflection's lobe reaches below the surface.
Vec3 Walk::draw_direction(Path& path, const Vertex& v, const RandomBlock& random) const {
  if (!v.hit) {
    // sample_scatter written out: a phase function's value and its density cancel, so the throughput stays.
    const scene::PhaseFunction& phase = medium(v.medium).phase;
    const double c = scene::sample_phase_cosine(phase, random.fine(0));
    path.direction_pdf = scene::phase_value(phase, c);
    return turned(v.w, c, random.coarse(2));
  }
  Vec3 out = sample_scatter(v, block(path, Purpose::scatter, 1).coarse(0), random.fine(0), random.coarse(2));
  path.direction_pdf = scatter_pdf(v, out);
  path.throughput *= path.direction_pdf > 0 ? Rgb(scatter_value(v, out) / path.direction_pdf) : Rgb(Rgb::Zero());
  ++path.reflections;
  return out;
}

}  // namespace airlight::path_tracer
