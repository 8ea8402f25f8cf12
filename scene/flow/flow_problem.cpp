#include "scene/flow/flow_problem.h"

#include <cmath>

#include "scene/base/kinds.h"

namespace airlight::scene {

std::string side_name(Side::Kind kind) {
  switch (kind) {
    case Side::Kind::periodic:
      return "periodic";
    case Side::Kind::free_slip:
      return "free_slip";
    case Side::Kind::no_slip:
      return "no_slip";
    case Side::Kind::open:
      return "open";
  }
  return "";
}

Vec3 velocity_at(const StartVelocity& start, const Box& box, const Point3& x) {
  return match(
      start, [](const AtRest&) -> Vec3 { return Vec3::Zero(); },
      [&](const TaylorGreen& v) -> Vec3 {
        const double kx = 2 * pi * v.waves / box.size()[0], ky = 2 * pi * v.waves / box.size()[1];
        const double px = kx * (x[0] - box.lo[0]), py = ky * (x[1] - box.lo[1]);
        return v.speed * Vec3(std::sin(px) * std::cos(py), -kx / ky * std::cos(px) * std::sin(py), 0);
      },
      [&](const Swirl& v) -> Vec3 {
        const double sx = pi / box.size()[0], sy = pi / box.size()[1];
        const double px = sx * (x[0] - box.lo[0]), py = sy * (x[1] - box.lo[1]);
        return v.speed * Vec3(std::pow(std::sin(px), 2) * std::sin(2 * py),
                              -sx / sy * std::sin(2 * px) * std::pow(std::sin(py), 2), 0);
      },
      [&](const RigidRotation& v) -> Vec3 { return v.rate.cross(x - v.center); },
      [&](const Wind& v) -> Vec3 { return v.velocity; });
}

FlowProblem with_density(const FlowProblem& problem, int which) {
  FlowProblem one = problem;
  one.densities.clear();
  for (Source& s : one.sources) {
    if (s.of != which) s.density_rate = 0, s.density.reset();
    s.of = 0;
  }
  for (auto& axis : one.sides)
    for (Side& side : axis) {
      if (side.of != which) side.density = 0;
      side.of = 0;
    }
  if (which > 0) {
    const NamedDensity& own = problem.densities.at(std::size_t(which) - 1);
    for (Blob& blob : one.blobs) blob.density = 0;
    one.blobs.insert(one.blobs.end(), own.blobs.begin(), own.blobs.end());
    one.density = own.density;
    one.wave = own.wave;
    one.density_grid = own.grid;
  }
  one.hash = content_hash(one);
  return one;
}

std::string density_name(const FlowProblem& problem, int which) {
  return which == 0 ? "density" : problem.densities.at(std::size_t(which) - 1).name;
}

namespace {

double blob_at(const Blob& blob, const Point3& x) {
  return std::exp(-(x - blob.center).squaredNorm() / (blob.width * blob.width));
}

}  // namespace

Vec3 start_velocity(const FlowProblem& problem, const Point3& x) {
  Vec3 sum = velocity_at(problem.velocity, problem.box, x);
  for (int a = 0; a < problem.dimensions && problem.velocity_grid; ++a)
    sum[a] += start_value((*problem.velocity_grid)[a], x);
  return sum;
}

double start_velocity(const FlowProblem& problem, int axis, const Point3& x) {
  const double sum = velocity_at(problem.velocity, problem.box, x)[axis];
  return problem.velocity_grid ? sum + start_value((*problem.velocity_grid)[axis], x) : sum;
}

double wave_at(const Wave& wave, const Box& box, const Point3& x) {
  double phase = wave.phase;
  for (int a = 0; a < 3; ++a)
    if (box.size()[a] > 0) phase += 2 * pi * wave.waves[a] * (x[a] - box.lo[a]) / box.size()[a];
  return wave.density * std::cos(phase);
}

double start_density(const FlowProblem& problem, const Point3& x) {
  double sum = problem.density;
  for (const Blob& blob : problem.blobs) sum += blob.density * blob_at(blob, x);
  if (problem.wave) sum += wave_at(*problem.wave, problem.box, x) + problem.wave->offset;
  if (problem.density_grid) sum += start_value(*problem.density_grid, x);
  return sum;
}

double start_temperature(const FlowProblem& problem, const Point3& x) {
  double sum = problem.temperature;
  for (const Blob& blob : problem.blobs) sum += blob.temperature * blob_at(blob, x);
  if (problem.temperature_grid) sum += start_value(*problem.temperature_grid, x);
  return sum;
}

}  // namespace airlight::scene
