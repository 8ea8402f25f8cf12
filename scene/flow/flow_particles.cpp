#include "scene/flow/flow_particles.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <cstring>

#include "scene/base/threads.h"
#include "scene/flow/random_points.h"

namespace airlight::scene {
namespace {

// Numbers of draws after which those of respawning begin: the first are of places in the region.
constexpr std::uint32_t respawned = 1u << 16;
constexpr std::size_t least_together = 128;  // particles of a task

void add(std::vector<Vec3>& sum, const std::vector<Vec3>& u, double share) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += share * u[i];
}

}  // namespace

FlowParticles::FlowParticles(const FlowProblem& problem)
    : box_(problem.box), dimensions_(problem.dimensions), sets_(problem.particles) {
  for (const ParticleSet& set : sets_) {
    const Box part = intersect(bounding_box(set.region), box_);
    try {
      here_.positions.push_back(random_points(set.region, part, std::size_t(set.count), set.seed));
    } catch (const Error& e) {
      throw Error(fmt::format("{}: {}", problem.file, e.what()));
    }
    here_.times.emplace_back(set.count, 0.0);
  }
}

void FlowParticles::step(const Flow& before, const Flow& after, double dt, const Execution& execution) {
  // Downloads the velocities from a device on this thread, not in a task.
  for (const Flow* flow : {&before, &after}) flow->velocity(box_.center());
  tbb::task_arena arena(threads_for(execution.threads));
  for (std::size_t s = 0; s < sets_.size(); ++s)
    arena.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, here_.positions[s].size(), least_together),
                        [&](const auto& range) { move(before, after, dt, s, range.begin(), range.end()); });
    });
}

// Runge and Kutta's, of a velocity that is linear in time over the step.
void FlowParticles::move(const Flow& before, const Flow& after, double dt, std::size_t s, std::size_t begin,
                         std::size_t end) {
  const ParticleSet& set = sets_[s];
  const auto at = [&](std::size_t i) -> Point3& { return here_.positions[s][begin + i]; };
  const std::size_t count = end - begin;
  const std::vector<Vec3> still(count, Vec3::Zero());
  // Velocities `ahead` seconds along `u`, from `share` of the way between the two flows.
  const auto slope = [&](const std::vector<Vec3>& u, double ahead, double share) {
    std::vector<Point3> x(count);
    for (std::size_t i = 0; i < count; ++i) x[i] = at(i) + ahead * u[i];
    std::vector<Vec3> sum(count, set.fall);
    if (share < 1) add(sum, before.velocities(x), 1 - share);
    if (share > 0) add(sum, after.velocities(x), share);
    return sum;
  };
  const auto a = slope(still, 0, 0), b = slope(a, 0.5 * dt, 0.5), c = slope(b, 0.5 * dt, 0.5), d = slope(c, dt, 1);
  for (std::size_t i = 0; i < count; ++i) {
    at(i) += dt / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    let_leave(set, begin + i, at(i), here_.times[s][begin + i]);
  }
}

// Where nothing passes the walls only rounding, the method's error and the fall take a particle beyond them.
void FlowParticles::let_leave(const ParticleSet& set, std::size_t i, Point3& x, double& times) const {
  for (int a = 0; a < dimensions_; ++a) {
    const double size = box_.size()[a], low = box_.lo[a];
    if (x[a] >= low && x[a] <= box_.hi[a]) continue;
    if (set.leaving != ParticleSet::Leaving::stay) {
      // On the other side, as far from it as it is beyond this one.
      x[a] = low + size * (((x[a] - low) / size) - std::floor((x[a] - low) / size));
      if (set.leaving == ParticleSet::Leaving::respawn) {
        times += 1;
        const Vec3 share = random_shares(set.seed, i, std::uint32_t(times) + respawned);
        for (int b = 0; b < dimensions_; ++b)
          if (b != a) x[b] = box_.lo[b] + box_.size()[b] * share[b];
      }
    }
    x[a] = std::clamp(x[a], low, box_.hi[a]);
  }
}

bool FlowParticles::ride(const Flow& flow) {
  if (empty()) return false;
  mover_ = flow.particle_mover(now());
  return mover_ != nullptr;
}

void FlowParticles::step(double dt) {
  mover_->step(dt);
  moved_ = true;
}

const ParticlePlaces& FlowParticles::now() const {
  if (!moved_) return here_;
  mover_->read(here_);
  for (const auto& set : here_.positions)
    for (const Point3& x : set)
      if (!x.allFinite()) throw Error("the place of a particle is no longer a number");
  moved_ = false;
  return here_;
}

std::string FlowParticles::csv() const {
  std::string text = std::string(particle_header) + "\n";
  const auto& positions = this->positions();
  for (std::size_t s = 0; s < positions.size(); ++s)
    for (const Point3& x : positions[s]) text += fmt::format("{},{},{},{}\n", s, x[0], x[1], x[2]);
  return text;
}

std::string FlowParticles::state() const {
  std::string bytes;
  const auto add = [&](const double* from, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(from), count * sizeof(double));
  };
  const ParticlePlaces& places = now();
  for (std::size_t s = 0; s < places.positions.size(); ++s) {
    for (const Point3& x : places.positions[s]) add(x.data(), 3);
    add(places.times[s].data(), places.times[s].size());
  }
  return bytes;
}

void FlowParticles::restore(const std::string& state) {
  std::size_t at = 0, expected = 0;
  for (const auto& set : here_.positions) expected += 4 * set.size() * sizeof(double);
  if (state.size() != expected)
    throw Error(fmt::format("a state of {} bytes of particles, expected {}", state.size(), expected));
  const auto take = [&](double* to, std::size_t count) {
    std::memcpy(to, state.data() + at, count * sizeof(double));
    at += count * sizeof(double);
  };
  for (std::size_t s = 0; s < here_.positions.size(); ++s) {
    for (Point3& x : here_.positions[s]) take(x.data(), 3);
    take(here_.times[s].data(), here_.times[s].size());
  }
  moved_ = false;
  if (mover_) mover_->write(here_);
}

}  // namespace airlight::scene
