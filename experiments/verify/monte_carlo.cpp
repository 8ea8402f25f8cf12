#include "experiments/verify/monte_carlo.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/application/interrupt.h"
#include "scene/base/error.h"

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

// Collisions of a path that begins with the ray, about at most: as many as absorption lets happen, twice the depth in
// the thinnest direction from outside (the mean chord's theorem), half its square from within (a walk at random).
double longest_walk(const scene::Scene& scene, const Ray& ray) {
  double walk = 1;
  for (const scene::Medium& medium : scene.media) {
    const Box box = scene::bounding_box(medium);
    const double sigma = medium.sigma_t.maxCoeff(), albedo = medium.albedo.maxCoeff();
    if (!(sigma > 0) || box.empty()) continue;
    const double depth = sigma * scene::density_bounds(medium, box).hi * box.size().minCoeff();
    const double steps = scene::contains(medium.region, ray.origin) ? 0.5 * depth * depth : 2 * depth;
    walk += std::min(1 / std::max(1 - albedo, 1e-300), steps);
  }
  return walk;
}

}  // namespace

Effort fixed(std::uint64_t samples, VerifyProfile profile) {
  Effort effort = aim(0, profile);
  effort.least = effort.most = samples;
  effort.collisions = infinity;
  return effort;
}

Effort aim(double se, VerifyProfile profile) {
  Effort effort;
  effort.se = se;
  if (profile == VerifyProfile::paper) {
    effort.most <<= 4;
    effort.collisions *= 100;
    effort.refused *= 100;
  }
  return effort;
}

Measurement::Measurement(const scene::Scene& scene, Detector detector, int orders, std::string name)
    : scene_(std::make_shared<const scene::Scene>(scene)),
      detector_(std::move(detector)),
      ray_{Point3::Zero(), Vec3::UnitZ()},
      orders_(orders),
      name_(std::move(name)) {}

Measurement::Measurement(const scene::Scene& scene, const Ray& ray, int orders, std::string name)
    : scene_(std::make_shared<const scene::Scene>(scene)), ray_(ray), orders_(orders), name_(std::move(name)) {}

RadianceEstimate Measurement::trace(std::uint64_t samples, std::uint32_t stream, std::uint32_t repeat,
                                    bool analog) const {
  path_tracer::Options options;
  options.orders = orders_;
  options.stream = stream;
  if (analog) options.roulette_order = 0;
  options.forced = !analog;
  const World world(scene_, options);
  const std::uint32_t index = index_of(name_) + repeat;
  const scene::Execution execution = quiet_execution(0);
  return detector_ ? path_tracer::mean_radiance(world, detector_, samples, execution, index)
                   : path_tracer::radiance(world, ray_, samples, execution, index);
}

void Measurement::check(std::uint64_t samples, const Effort& effort) const {
  const Ray ray = detector_ ? detector_(RandomBlock{philox4x32_10({0, 0, 0, 0}, {0, 0})}) : ray_;
  const double needed = double(samples) * longest_walk(*scene_, ray);
  if (!(needed <= effort.refused))
    throw Error(
        fmt::format("{} paths may take {:.1g} collisions, expected at most {:.0e}: less depth, or a lower albedo",
                    samples, needed, effort.refused));
}

double Measurement::collisions_for(const Effort& effort) const {
  check(pilot_samples, effort);
  const RadianceEstimate pilot = trace(pilot_samples, 2, 0);
  const double ratio = pilot.total.error[0] / effort.se;
  return double(pilot.counters.collisions) * ratio * ratio;
}

RadianceEstimate Measurement::run(const Effort& effort) const {
  double samples = double(effort.least);
  check(effort.se > 0 ? pilot_samples : effort.least, effort);
  if (effort.se > 0) {
    const RadianceEstimate pilot = trace(pilot_samples, 2, 0);
    const double ratio = pilot.total.error[0] / effort.se;
    const double per_path = double(pilot.counters.collisions) / double(pilot_samples);
    samples = std::max(1.1 * double(pilot_samples) * ratio * ratio, double(effort.least));
    samples = std::min({samples, double(effort.most), effort.collisions / std::max(per_path, 0.1)});
  }
  return trace((std::uint64_t(samples) + 1023) / 1024 * 1024, 1, 0);
}

path_tracer::Estimate Measurement::collisions(const Effort& effort) const {
  constexpr int repeats = 16;
  check(effort.least, effort);
  double sum = 0, square = 0;
  for (int i = 0; i < repeats; ++i) {
    const RadianceEstimate got = trace(effort.least / repeats, 1, std::uint32_t(i), true);
    const double mean = double(got.counters.collisions) / double(got.samples);
    sum += mean;
    square += mean * mean;
  }
  path_tracer::Estimate result;
  const double mean = sum / repeats;
  result.mean = Rgb::Constant(mean);
  result.error = Rgb::Constant(std::sqrt((square / repeats - mean * mean) / (repeats - 1)));
  return result;
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
