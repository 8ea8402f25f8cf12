#include "experiments/verify/monte_carlo.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace airlight::experiments::verification {
namespace {

using path_tracer::RadianceEstimate;
using path_tracer::World;

constexpr std::uint64_t pilot_samples = 1 << 12;

// FNV-1a.
std::uint32_t index_of(const std::string& name) {
  std::uint32_t hash = 2166136261u;
  for (const unsigned char c : name) hash = (hash ^ c) * 16777619u;
  return hash;
}

World world(const scene::Scene& scene, int orders, std::uint32_t stream) {
  path_tracer::Options options;
  options.orders = orders;
  options.stream = stream;
  return {std::make_shared<const scene::Scene>(scene), options};
}

template <class Run>
RadianceEstimate measure_with(const scene::Scene& scene, int orders, const Effort& effort, Run run) {
  std::uint64_t samples = effort.least;
  if (effort.se > 0) {
    const double pilot = run(world(scene, orders, 2), pilot_samples).total.error[0];
    const double needed = double(pilot_samples) * (pilot / effort.se) * (pilot / effort.se);
    samples = std::uint64_t(std::clamp(needed * 1.1, double(effort.least), double(effort.most)));
  }
  return run(world(scene, orders, 1), (samples + 1023) / 1024 * 1024);
}

}  // namespace

RadianceEstimate measure(const scene::Scene& scene, const Detector& detector, int orders, const Effort& effort,
                         const std::string& name) {
  return measure_with(scene, orders, effort, [&](const World& w, std::uint64_t samples) {
    return path_tracer::mean_radiance(w, detector, samples, {}, index_of(name));
  });
}

RadianceEstimate measure(const scene::Scene& scene, const Ray& ray, int orders, const Effort& effort,
                         const std::string& name) {
  return measure_with(scene, orders, effort, [&](const World& w, std::uint64_t samples) {
    return path_tracer::radiance(w, ray, samples, {}, index_of(name));
  });
}

Detector cosine_detector(const Point3& origin, const Vec3& axis) {
  const Vec3 a = axis.unitOrthogonal(), b = axis.cross(a);
  return [=](const RandomBlock& random) {
    const double cosine = std::sqrt(random.fine(0)), sine = std::sqrt(1 - random.fine(0));
    const double angle = 2 * pi * random.fine(1);
    return Ray{origin, (cosine * axis + sine * (std::cos(angle) * a + std::sin(angle) * b)).normalized()};
  };
}

Detector isotropic_detector(const Point3& origin) {
  return [=](const RandomBlock& random) {
    const double z = 2 * random.fine(0) - 1, angle = 2 * pi * random.fine(1), r = std::sqrt(1 - z * z);
    return Ray{origin, Vec3(r * std::cos(angle), r * std::sin(angle), z).normalized()};
  };
}

Vec3 slanted(double mu) { return {std::sqrt((1 - mu) * (1 + mu)), 0, mu}; }

}  // namespace airlight::experiments::verification
