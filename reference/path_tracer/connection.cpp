#include <algorithm>
#include <array>
#include <cmath>

#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/walk.h"

namespace airlight::path_tracer {

// On the camera's ray, whose direction was not drawn.
void Walk::connect_from_eye(const Path& path, double u_pick) const {
  const auto& [ray, end, hull, flight] = *path.segment;
  const Pick pick = lights_.pick_for_ray(ray, hull, u_pick);
  if (pick.light < 0) return;
  const Connection connection{ray, hull, path.throughput, flight.gain, 1.0, path.reflections};
  connect(path, connection, pick, 1.0, block(path, Purpose::connection).fine(0));
}

// From a vertex: a direction half by phase function or reflection, half with density 1/(2 pi^2 sin theta) about the
// direction to the light, which with equal angles on the ray bounds the contribution.
void Walk::connect_from(const Path& path, const Vertex& v) const {
  const RandomBlock numbers = block(path, Purpose::connection);
  const RandomBlock choice = block(path, Purpose::connection, 1);
  const Pick pick = lights_.pick_for_connection(v.x, choice.coarse(0));
  if (pick.light < 0) return;
  const Vec3 offset = scene::ball(lights_.light(pick.light))->center - v.x;
  const double length = offset.norm();
  if (!(length > 0)) return;
  const Vec3 axis = offset / length;
  Vec3 out;
  if (choice.coarse(1) < 0.5) {
    out = sample_scatter(v, choice.coarse(3), numbers.fine(0), choice.coarse(2));
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
  const Connection connection{ray,
                              hull,
                              path.throughput * value,
                              flight_on(path, ray, end, hull).gain,
                              scatter_pdf(v, out),
                              path.reflections + (v.hit != nullptr)};
  const double sine = (offset - offset.dot(out) * out).norm() / length;
  const double direction_pdf = 0.5 * (connection.direction_pdf + 1 / (2 * pi * pi * std::min(1.0, sine)));
  connect(path, connection, pick, direction_pdf, numbers.fine(1));
}

// Light of one point or spot light scattered once on the ray, at one point drawn with equal angles. The ray's direction
// was drawn with the density direction_pdf.
void Walk::connect(const Path& path, const Connection& connection, const Pick& pick, double direction_pdf,
                   double u) const {
  const Ray& ray = connection.ray;
  const scene::Light& light = lights_.light(pick.light);
  const Point3 center = scene::ball(light)->center;
  const Equiangular angles(ray, center, connection.hull);
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
  const Rgb T = transmittance(path, ray, t, 1);
  const Rgb light_T = transmittance(path, shadow, distance, 2);
  const double pdf = pick.probability * direction_pdf * angles.pdf(t);
  // The other way to the same point: the path's own collision there, with next-event estimation.
  const double pick_there = lights_.probability(pick.light, y);
  const double c = std::clamp(ray.direction.dot(to_light), -1.0, 1.0);
  Rgb sum = Rgb::Zero();
  for (std::size_t i = 0; i < tracked.size(); ++i) {
    if (!(densities[i] > 0)) continue;
    const scene::Medium& medium = *tracked[i].medium;
    const Rgb extinction = medium.sigma_t * densities[i];
    const Rgb own = path.density * extinction;
    const double analog =
        pick_there * connection.direction_pdf * (exact() ? (own * T * connection.gain).mean() : own.mean());
    sum += extinction * medium.albedo * (scene::phase_value(medium.phase, c) / (pdf + analog));
  }
  sample_.add(path.scatterings + 1, connection.reflections,
              connection.throughput * T * light_T * sum * intensity / angles.squared_distance(t));
}

// Density, over solid angle and distance, with which a connection from the start of the path's segment would make its
// point at t, the choice of the light included. The segment's own direction was drawn with path.direction_pdf.
double Walk::connection_pdf(const Path& path, int light, double t) const {
  const auto& [ray, end, hull, flight] = *path.segment;
  const Point3 center = scene::ball(lights_.light(light))->center;
  const Equiangular angles(ray, center, hull);
  if (!angles.usable()) return 0;
  const bool from_eye = path.vertex == 1;  // the path stands at the end of the segment
  if (from_eye) return lights_.probability_for_ray(light, ray, hull) * angles.pdf(t);
  const double sine = std::min(1.0, angles.h / (center - ray.origin).norm());
  const double toward = 1 / (2 * pi * pi * sine);
  return lights_.probability_for_connection(light, ray.origin) * 0.5 * (path.direction_pdf + toward) * angles.pdf(t);
}

}  // namespace airlight::path_tracer
