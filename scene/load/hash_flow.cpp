#include "scene/base/kinds.h"
#include "scene/flow/flow_problem.h"
#include "scene/load/hash_parts.h"

namespace airlight::scene {
using load::ContentHash;

namespace {

void add_start(ContentHash& hash, const std::vector<Blob>& blobs, const std::optional<Wave>& wave,
               const std::shared_ptr<const VoxelGrid>& grid) {
  hash.tag("blobs");
  for (const auto& [center, width, density, temperature] : blobs) hash.all(center, width, density, temperature);
  hash.tag(wave ? "wave" : "no wave");
  if (wave) {
    const auto& [waves, density, offset, phase] = *wave;
    hash.all(waves, density, offset, phase);
  }
  hash.tag(grid ? "density grid" : "no grid");
  if (grid) add(hash, *grid);
}

// The flow's velocity at the start.
void add_velocity(ContentHash& hash, const decltype(FlowProblem::velocity)& velocity) {
  match(
      velocity, [](const AtRest&) {},
      [&](const TaylorGreen& start) {
        const auto& [speed, waves] = start;
        hash.all(speed, waves);
      },
      [&](const Swirl& start) {
        const auto& [speed] = start;
        hash.add(speed);
      },
      [&](const RigidRotation& start) {
        const auto& [center, rate] = start;
        hash.all(center, rate);
      },
      [&](const Wind& start) {
        const auto& [mean, gust, frequency] = start;
        hash.add(mean);
        if (!gust.isZero(0)) hash.all(gust, frequency);
      });
}

// All but `of`, which content_hash adds.
void add_sources(ContentHash& hash, const std::vector<Source>& sources) {
  hash.tag("sources");
  for (const auto& [region, time, density_rate, temperature_rate, held, held_warmth, held_velocity, of] : sources) {
    add(hash, region);
    hash.all(time.lo, time.hi, density_rate, temperature_rate, held.value_or(-1), held_warmth.value_or(infinity),
             Vec3(held_velocity.value_or(Vec3::Constant(infinity))));
  }
}

}  // namespace

// Every structure is taken apart into all its members: one that is added later does not compile before this file says what it
// means for the hash.
std::string content_hash(const FlowProblem& problem) {
  const auto& [name, file, dimensions, box, sides, viscosity, diffusivity, decay, gravity, weight, expansion,
               confinement, velocity, velocity_stays, density, temperature, blobs, wave, densities, density_grid,
               temperature_grid, velocity_grid, sources, obstacles, pushes, particles, duration, frame_rate, known] =
      problem;
  ContentHash hash;
  hash.tag("airlight flow 1");
  hash.all(dimensions, box);
  for (const auto& axis : sides)
    for (const auto& [kind, moves, regularized, carried, warmth, of] : axis) {  // of: below
      hash.tag(side_name(kind));
      hash.all(moves, int(regularized), carried, warmth);
    }
  hash.all(viscosity, diffusivity, decay, weight, expansion, confinement, density, temperature, duration, frame_rate,
           gravity, int(velocity.index()));
  add_velocity(hash, velocity);
  hash.add(int(velocity_stays));
  add_start(hash, blobs, wave, density_grid);
  if (temperature_grid) {
    hash.tag("temperature grid");
    add(hash, *temperature_grid);
  }
  if (velocity_grid) {
    hash.tag("velocity grid");
    for (const VoxelGrid& component : *velocity_grid) add(hash, component);
  }
  add_sources(hash, sources);
  hash.tag("obstacles");
  for (const Surface& surface : obstacles) add(hash, surface);
  hash.tag("forces");
  for (const auto& [region, time, acceleration, frequency] : pushes) {
    add(hash, region);
    hash.all(acceleration, time.lo, time.hi, frequency);
  }
  for (const auto& [of_density, amount, its_blobs, its_wave, grid] : densities) {
    hash.tag("density " + of_density);
    hash.add(amount);
    add_start(hash, its_blobs, its_wave, grid);
  }
  if (!densities.empty()) {
    for (const auto& axis : sides)
      for (const Side& side : axis) hash.add(side.of);
    for (const Source& source : sources) hash.add(source.of);
  }
  for (const auto& [count, region, seed, fall, leaving] : particles) {
    hash.tag("particles");
    hash.add(count);
    add(hash, region);
    hash.all(std::int64_t(seed), fall, int(leaving));
  }
  return hash.digits();
}

}  // namespace airlight::scene
