#include "methods/fogshop/authoring/airbrush.h"

#include <fmt/format.h>

#include <cmath>

#include "methods/fogshop/authoring/draws.h"
#include "scene/base/error.h"
#include "scene/base/limits.h"

namespace airlight::fogshop::authoring {
namespace {

// A particle on its way; which Gaussian it is, and the birth of one that is not there yet.
struct Particle {
  Gaussian gaussian;
  std::size_t position;  // in the list; only of those that were there before
  bool old = false;
};

Vec3 mirrored(const Vec3& v, const Vec3& normal) { return v - 2 * v.dot(normal) * normal; }

}  // namespace

Flight bounce(const scene::Geometry* geometry, const Point3& from, Vec3 displacement, const Vec3& velocity) {
  Flight flight{from, velocity};
  for (int hits = 0; hits < 8; ++hits) {
    const double length = displacement.norm();
    if (!std::isfinite(length)) throw Error("a particle moves further than numbers go, expected a smaller speed");
    if (!(length > 0)) return flight;
    const Ray ray{flight.position, displacement / length};
    const auto hit = geometry ? geometry->first_hit(ray) : std::nullopt;
    // A hit beyond the end counts if the end is closer to it than the clearance.
    const double slope = hit ? std::abs(hit->normal.dot(ray.direction)) : 0;
    const double stop = hit ? (slope * hit->t > clearance ? hit->t - clearance / slope : 0) : infinity;
    if (length <= stop) {
      flight.position = ray.at(length);
      return flight;
    }
    flight.position = ray.at(stop);
    displacement = mirrored((length - stop) * ray.direction, hit->normal);
    // Only what flies into the surface is turned: a random kick may have sent the particle there on its own.
    if (flight.velocity.dot(hit->normal) < 0) flight.velocity = mirrored(flight.velocity, hit->normal);
  }
  return flight;
}

std::vector<Id> airbrush(GaussianList& list, const Airbrush& op, const scene::Geometry* geometry,
                         const std::function<void()>& each_step) {
  std::vector<Particle> particles;
  for (std::size_t i = 0; i < list.all().size(); ++i)
    if (!list.all()[i].velocity.isZero(0)) particles.push_back({list.all()[i], i, true});
  const double duration = op.steps * op.dt, births = std::ceil(duration * op.rate);
  if (!(births + double(list.all().size()) <= double(GaussianList::greatest)))
    throw Error(fmt::format("{:g} particles in {:g} s at a rate of {:g} 1/s: more than {} Gaussians", births, duration,
                            op.rate, GaussianList::greatest));
  if (!((births + double(particles.size())) * op.steps <= 1e9))
    throw Error(fmt::format("{} steps of {:g} particles, expected at most 1e9 moves", op.steps,
                            births + double(particles.size())));
  scene::require_time(1e-7 * (births + double(particles.size()) + 1) * op.steps,
                      fmt::format("airbrush of {} steps", op.steps));
  const std::size_t old = particles.size();
  for (int step = 0; step < op.steps; ++step) {
    each_step();
    const double end = (step + 1) * op.dt;
    // Births up to the end of this step, at multiples of 1 / rate.
    for (double k = double(particles.size() - old); k / op.rate < end && k < births; ++k) {
      Gaussian gaussian = op.brush;
      gaussian.b = op.position;
      gaussian.velocity = op.speed * Draws(op.seed, std::uint32_t(particles.size())).sphere();
      particles.push_back({gaussian, 0, false});
    }
    for (std::size_t i = 0; i < particles.size(); ++i) {
      Particle& p = particles[i];
      const double dt = p.old ? op.dt : std::min(op.dt, end - double(i - old) / op.rate);
      if (!(dt > 0)) continue;
      Vec3 displacement = p.gaussian.velocity * dt;
      if (op.diffusion > 0)
        displacement += op.diffusion * std::sqrt(dt) * Draws(op.seed, std::uint32_t(i)).normals(std::uint64_t(step));
      const Flight flight = bounce(geometry, p.gaussian.b, displacement, p.gaussian.velocity);
      p.gaussian.b = flight.position;
      p.gaussian.velocity = flight.velocity;
    }
  }
  std::vector<Id> ids;
  for (const Particle& p : particles) {
    if (p.old) list.change(p.position, p.gaussian);
    ids.push_back(p.old ? p.gaussian.id : list.add(p.gaussian));
  }
  return ids;
}

std::vector<Id> freeze(GaussianList& list) {
  std::vector<Id> ids;
  for (std::size_t i = 0; i < list.all().size(); ++i) {
    Gaussian gaussian = list.all()[i];
    if (gaussian.velocity.isZero(0)) continue;
    gaussian.velocity.setZero();
    list.change(i, gaussian);
    ids.push_back(gaussian.id);
  }
  return ids;
}

}  // namespace airlight::fogshop::authoring
