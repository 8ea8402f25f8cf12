#include <algorithm>

#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/surface_sampling.h"
#include "reference/path_tracer/walk.h"

namespace airlight::path_tracer {

Rgb Walk::scatter_value(const Vertex& v, const Vec3& out) const {
  if (v.hit) {
    const double cosine = v.hit->normal.dot(out);
    if (!(cosine > 0)) return Rgb::Zero();
    return scene::brdf(material(v), v.hit->normal, -v.w, out) * cosine;
  }
  const double c = std::clamp(v.w.dot(out), -1.0, 1.0);
  return Rgb::Constant(scene::phase_value(medium(v.medium).phase, c));
}

double Walk::scatter_pdf(const Vertex& v, const Vec3& out) const {
  if (v.hit) return pdf_reflection(material(v), v.hit->normal, -v.w, out);
  return scene::phase_value(medium(v.medium).phase, std::clamp(v.w.dot(out), -1.0, 1.0));
}

Vec3 Walk::sample_scatter(const Vertex& v, double u_lobe, double u, double turns) const {
  if (v.hit) return sample_reflection(material(v), v.hit->normal, -v.w, u_lobe, u, turns);
  return turned(v.w, scene::sample_phase_cosine(medium(v.medium).phase, u), turns);
}

// Next-event estimation: one light, picked by what it would send.
void Walk::next_event(const Path& path, const Vertex& v) const {
  if (!lights_.any()) return;
  const RandomBlock numbers = block(path, Purpose::light);
  const Pick pick = lights_.pick(v.x, numbers.coarse(3));
  if (pick.light < 0) return;
  if (scene::is_delta(lights_.light(pick.light)))
    next_event_delta(path, v, pick);
  else
    next_event_environment(path, v, pick, numbers.fine(0), numbers.coarse(2));
}

void Walk::next_event_delta(const Path& path, const Vertex& v, const Pick& pick) const {
  const scene::Incident in = scene::incident(lights_.light(pick.light), v.x);
  if (!(in.irradiance.maxCoeff() > 0)) return;
  const Rgb value = scatter_value(v, in.to_light);
  if (!(value.maxCoeff() > 0)) return;
  double weight = 1 / pick.probability;
  if (!v.hit && lights_.connected(pick.light)) {
    // The balance heuristic's share. collide() has divided the throughput by the mean of analog_pdf already.
    const double analog = pick.probability * v.analog_pdf.mean();
    const double t = (v.x - path.segment->ray.origin).dot(path.segment->ray.direction);
    weight *= analog / (analog + connection_pdf(path, pick.light, t));
  }
  const Ray shadow{origin(v, in.to_light), in.to_light};
  if (!world_.visible(shadow, in.distance, pick.light)) return;
  const Rgb T = transmittance(path, shadow, in.distance, 0);
  sample_.add(path.scatterings, path.reflections + (v.hit != nullptr),
              path.throughput * value * in.irradiance * T * weight);
}

void Walk::next_event_environment(const Path& path, const Vertex& v, const Pick& pick, double u1, double u2) const {
  const auto& environment = std::get<scene::EnvironmentLight>(lights_.light(pick.light));
  const Vec3 out = scene::sample_environment(environment, u1, u2);
  const Rgb value = scatter_value(v, out);
  if (!(value.maxCoeff() > 0)) return;
  const auto [radiance, density] = scene::evaluate_environment(environment, out);
  const double pdf = pick.probability * density;
  if (!(pdf > 0) || (radiance == 0).all()) return;
  const Ray shadow{origin(v, out), out};
  if (!world_.visible(shadow, infinity, -1)) return;
  const Rgb T = transmittance(path, shadow, infinity, 0);
  // 1 / pdf, times the balance heuristic's pdf / (pdf + scatter_pdf).
  sample_.add(path.scatterings, path.reflections + (v.hit != nullptr),
              path.throughput * value * radiance * T / (pdf + scatter_pdf(v, out)));
}

// The path leaves the scene along its segment: environments, weighted against their own sampling at the vertex before.
void Walk::escape(const Path& path, const Rgb& throughput) const {
  if (lights_.environments().empty() || path.vertex == 0 || ends_unseen(path)) return;
  for (const int i : lights_.environments()) {
    const auto& environment = std::get<scene::EnvironmentLight>(lights_.light(i));
    const auto [radiance, density] = scene::evaluate_environment(environment, path.segment->ray.direction);
    if ((radiance == 0).all()) continue;
    const double pdf = lights_.probability(i, path.segment->ray.origin) * density;
    sample_.add(path.scatterings, path.reflections,
                throughput * radiance * (path.direction_pdf / (path.direction_pdf + pdf)));
  }
}

}  // namespace airlight::path_tracer
