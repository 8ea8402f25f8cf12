#include "reference/path_tracer/path.h"

#include <algorithm>
#include <cmath>

#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/surface_sampling.h"
#include "reference/path_tracer/walk.h"

namespace airlight::path_tracer {

Rgb Walk::scatter_value(const Vertex& v, const Vec3& out) const {
  if (v.hit) {
    const double cosine = v.hit->normal.dot(out);
    if (!(cosine > 0)) return Rgb::Zero();
    return scene::brdf(world_.scene().surfaces[v.hit->surface].material, v.hit->normal, -v.w, out) * cosine;
  }
  const double c = std::clamp(v.w.dot(out), -1.0, 1.0);
  return Rgb::Constant(scene::phase_value(media_.tracked()[v.medium].medium->phase, c));
}

double Walk::scatter_pdf(const Vertex& v, const Vec3& out) const {
  if (v.hit) return pdf_reflection(world_.scene().surfaces[v.hit->surface].material, v.hit->normal, -v.w, out);
  return scene::phase_value(media_.tracked()[v.medium].medium->phase, std::clamp(v.w.dot(out), -1.0, 1.0));
}

// Density, over solid angle and distance, with which the connection from the start of a ray would make its point at t,
// the choice of the light included. The ray's own direction was drawn with direction_pdf_.
double Walk::connection_pdf(int light, const Ray& ray, Interval hull, double t) const {
  const Point3 center = scene::ball(lights_.light(light))->center;
  const Equiangular angles(ray, center, hull);
  if (!angles.usable()) return 0;
  if (vertex_ == 0) return lights_.probability_for_ray(light, ray, hull) * angles.pdf(t);
  const double sine = std::min(1.0, angles.h / (center - ray.origin).norm());
  const double toward = 1 / (2 * pi * pi * sine);
  return lights_.probability_for_connection(light, ray.origin) * 0.5 * (direction_pdf_ + toward) * angles.pdf(t);
}

bool Walk::survive(double u) {
  const Options& o = world_.options();
  if (m_ + s_ < o.roulette_order) return true;
  const double q = std::min(o.roulette_cap, throughput_.maxCoeff() / scale_);
  if (q >= 1) return true;
  if (!(u < q)) return false;
  throughput_ /= q;
  return true;
}

// Next-event estimation at a vertex: one light. `analog_pdf[c]`, for a vertex in a medium, is the density over solid
// angle and distance with which channel c's walk made this vertex out of the one before (used where lights are
// connected).
void Walk::gather(const Vertex& v, const Rgb& analog_pdf) {
  if (!lights_.any()) return;
  const RandomBlock numbers = block(Purpose::light);
  const Pick pick = lights_.pick(v.x, numbers.coarse(3));
  if (pick.light < 0) return;
  if (scene::is_delta(lights_.light(pick.light)))
    gather_delta(v, pick, analog_pdf);
  else
    gather_environment(v, pick, numbers.fine(0), numbers.coarse(2));
}

void Walk::gather_delta(const Vertex& v, const Pick& pick, const Rgb& analog_pdf) {
  const scene::Incident in = scene::incident(lights_.light(pick.light), v.x);
  if (!(in.irradiance.maxCoeff() > 0)) return;
  const Rgb value = scatter_value(v, in.to_light);
  if (!(value.maxCoeff() > 0)) return;
  double weight = 1 / pick.probability;
  if (!v.hit && lights_.connected(pick.light)) {
    // Both densities relative to the mean of the channels before the segment that led here; throughput_ already stands
    // on the mean after it, analog_pdf's.
    const double analog = pick.probability * analog_pdf.mean();
    const double t = (v.x - ray_.origin).dot(ray_.direction);
    --vertex_;  // the connection would have started at the vertex before
    const double connection = connection_pdf(pick.light, ray_, hull_, t);
    ++vertex_;
    weight *= analog / (analog + connection);
  }
  const Ray shadow{origin(v, in.to_light), in.to_light};
  if (!world_.visible(shadow, in.distance, pick.light)) return;
  const Rgb radiance = throughput_ * value * in.irradiance * transmittance(shadow, in.distance, 0) * weight;
  if (v.hit && world_.options().paths == Options::Paths::scattered_to_surface) return;
  sample_.add(m_, s_ + (v.hit != nullptr), radiance);
}

void Walk::gather_environment(const Vertex& v, const Pick& pick, double u1, double u2) {
  const auto& environment = std::get<scene::EnvironmentLight>(lights_.light(pick.light));
  const Vec3 out = scene::sample_environment(environment, u1, u2);
  const Rgb value = scatter_value(v, out);
  if (!(value.maxCoeff() > 0)) return;
  const auto [radiance, density] = scene::evaluate_environment(environment, out);
  const double pdf = pick.probability * density;
  if (!(pdf > 0) || (radiance == 0).all()) return;
  const Ray shadow{origin(v, out), out};
  if (!world_.visible(shadow, infinity, -1)) return;
  const Rgb T = transmittance(shadow, infinity, 0);
  const double walk = scatter_pdf(v, out);
  sample_.add(m_, s_ + (v.hit != nullptr), throughput_ * value * radiance * T / (pdf + walk));
}

// Light of one point or spot light scattered once on a ray, at one point drawn with equal angles; `reflections` on the
// way, that at the start of the ray included. `gain` is of the walk's own collisions on it.
void Walk::connect(const Ray& ray, Interval hull, const Rgb& throughput, const Pick& pick, double direction_pdf,
                   const Rgb& gain, bool from_camera, int reflections, double u) {
  const scene::Light& light = lights_.light(pick.light);
  const Point3 center = scene::ball(light)->center;
  const Equiangular angles(ray, center, hull);
  if (!angles.usable()) return;
  const double t = angles.sample(u);
  const Point3 y = ray.at(t);
  double extinction_there = 0;
  std::array<double, 64> densities;
  const auto& tracked = media_.tracked();
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    densities[i] = scene::density(*tracked[i].medium, y);
    extinction_there += densities[i];
  }
  if (!(extinction_there > 0)) return;

  const double distance = std::sqrt(angles.squared_distance(t));
  const Vec3 to_light = (center - y) / (center - y).norm();
  const Rgb intensity = scene::intensity_towards(light, -to_light);
  if (!(intensity.maxCoeff() > 0)) return;
  const Ray shadow{y, to_light};
  if (!world_.visible(shadow, distance, pick.light)) return;

  ++counters_.connections;
  const Rgb T = transmittance(ray, t, 1);
  const Rgb light_T = transmittance(shadow, distance, 2);
  const double pdf = pick.probability * direction_pdf * angles.pdf(t);
  // The other way to the same point: the walk's own collision there, with next-event estimation.
  const double pick_there = lights_.probability(pick.light, y);
  const double walk_pdf = from_camera ? 1.0 : direction_pdf_;
  const double c = std::clamp(ray.direction.dot(to_light), -1.0, 1.0);
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    if (!(densities[i] > 0)) continue;
    const scene::Medium& medium = *tracked[i].medium;
    const Rgb extinction = medium.sigma_t * densities[i];
    const double analog =
        pick_there * walk_pdf * (exact() ? (density_ * extinction * T * gain).mean() : (density_ * extinction).mean());
    sum += extinction * medium.albedo * (scene::phase_value(medium.phase, c) / (pdf + analog));
  }
  sample_.add(m_ + 1, reflections, throughput * T * light_T * sum * intensity / angles.squared_distance(t));
}

// The connection from a vertex: a direction half by phase function or reflection, half with density 1/(2 pi^2 sin
// theta) about the direction to the light, which with equal angles on the ray bounds the contribution.
void Walk::connect_from(const Vertex& v) {
  const RandomBlock numbers = block(Purpose::connection);
  const RandomBlock choice = block(Purpose::connection, 1);
  const Pick pick = lights_.pick_for_connection(v.x, choice.coarse(0));
  if (pick.light < 0) return;
  const Vec3 offset = scene::ball(lights_.light(pick.light))->center - v.x;
  const double length = offset.norm();
  if (!(length > 0)) return;
  const Vec3 axis = offset / length;
  Vec3 out;
  if (choice.coarse(1) < 0.5) {
    if (v.hit)
      out = sample_reflection(world_.scene().surfaces[v.hit->surface].material, v.hit->normal, -v.w, choice.coarse(3),
                              numbers.fine(0), choice.coarse(2));
    else
      out = turned(v.w, scene::sample_phase_cosine(media_.tracked()[v.medium].medium->phase, numbers.fine(0)),
                   choice.coarse(2));
  } else {
    const elementary::SinCos theta = elementary::sincos_turns(0.5 * numbers.fine(0));
    out = turned(axis, theta.cos, theta.sin, choice.coarse(2));
  }
  const Rgb value = scatter_value(v, out);
  if (!(value.maxCoeff() > 0)) return;
  const Ray ray{origin(v, out), out};
  ++counters_.rays;
  const scene::RayEnd end = scene::ray_end(world_.scene(), ray);
  const Interval hull = media_.hull(ray, end.t);
  if (hull.empty()) return;
  const double sine = (offset - offset.dot(out) * out).norm() / length;
  direction_pdf_ = scatter_pdf(v, out);
  const double direction_pdf = 0.5 * (direction_pdf_ + 1 / (2 * pi * pi * std::min(1.0, sine)));
  connect(ray, hull, throughput_ * value, pick, direction_pdf, flight_on(ray, end, hull).gain, false,
          s_ + (v.hit != nullptr), numbers.fine(1));
}

// The walk left the scene along ray_: environments, weighted against their own sampling at the vertex before.
void Walk::escape(const Ray& ray) {
  if (lights_.environments().empty() || vertex_ == 0) return;
  for (const int i : lights_.environments()) {
    const auto& environment = std::get<scene::EnvironmentLight>(lights_.light(i));
    const auto [radiance, density] = scene::evaluate_environment(environment, ray.direction);
    if ((radiance == 0).all()) continue;
    const double pdf = lights_.probability(i, ray.origin) * density;
    sample_.add(m_, s_, throughput_ * radiance * (direction_pdf_ / (direction_pdf_ + pdf)));
  }
}

void trace(const World& world, const CameraRay& camera, const SampleRandom& random, PathSample& sample,
           Counters& counters) {
  ++counters.paths;
  Walk walk(world, random, sample, counters);
  if (world.options().only_lit_surfaces())
    walk.run_to_surface(camera);
  else
    walk.run(camera);
}

}  // namespace airlight::path_tracer
