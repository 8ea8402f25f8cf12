#include "scene/flow_problem.h"
#include "scene/kinds.h"
#include "scene/load/hash_parts.h"

namespace airlight::scene {
using load::ContentHash;

namespace {

void add_start(ContentHash& hash, const std::vector<Blob>& blobs, const std::optional<Wave>& wave,
               const std::shared_ptr<const VoxelGrid>& grid) {
  hash.tag("blobs");
  for (const Blob& blob : blobs) {
    hash.add(blob.center);
    for (const double value : {blob.width, blob.density, blob.temperature}) hash.add(value);
  }
  hash.tag(wave ? "wave" : "no wave");
  if (wave) {
    hash.add(wave->waves);
    for (const double value : {wave->density, wave->offset, wave->phase}) hash.add(value);
  }
  hash.tag(grid ? "density grid" : "no grid");
  if (grid) add(hash, *grid);
}

}  // namespace

std::string content_hash(const FlowProblem& p) {
  ContentHash hash;
  hash.tag("airlight flow 1");
  hash.add(p.dimensions);
  hash.add(p.box);
  for (const auto& axis : p.sides)
    for (const Side& side : axis) {
      hash.tag(side_name(side.kind));
      hash.add(side.velocity);
      hash.add(int(side.regularized));
      hash.add(side.density);
      hash.add(side.temperature);
    }
  for (const double value : {p.viscosity, p.diffusivity, p.decay, p.weight, p.expansion, p.confinement, p.density,
                             p.temperature, p.duration, p.frame_rate})
    hash.add(value);
  hash.add(p.gravity);
  hash.add(int(p.velocity.index()));
  match(
      p.velocity, [](const AtRest&) {},
      [&](const TaylorGreen& v) {
        hash.add(v.speed);
        hash.add(v.waves);
      },
      [&](const Swirl& v) { hash.add(v.speed); },
      [&](const RigidRotation& v) {
        hash.add(v.center);
        hash.add(v.rate);
      },
      [&](const Wind& v) {
        hash.add(v.velocity);
        if (v.gust.isZero(0)) return;
        hash.add(v.gust);
        hash.add(v.frequency);
      });
  hash.add(int(p.velocity_stays));
  add_start(hash, p.blobs, p.wave, p.density_grid);
  if (p.temperature_grid) {
    hash.tag("temperature grid");
    add(hash, *p.temperature_grid);
  }
  if (p.velocity_grid) {
    hash.tag("velocity grid");
    for (const VoxelGrid& component : *p.velocity_grid) add(hash, component);
  }
  hash.tag("sources");
  for (const Source& s : p.sources) {
    add(hash, s.region);
    for (const double value : {s.time.lo, s.time.hi, s.density_rate, s.temperature_rate, s.density.value_or(-1),
                               s.temperature.value_or(infinity)})
      hash.add(value);
    hash.add(s.velocity.value_or(Vec3::Constant(infinity)));
  }
  hash.tag("obstacles");
  for (const Surface& surface : p.obstacles) add(hash, surface);
  hash.tag("forces");
  for (const Push& push : p.pushes) {
    add(hash, push.region);
    hash.add(push.acceleration);
    for (const double value : {push.time.lo, push.time.hi, push.frequency}) hash.add(value);
  }
  for (const NamedDensity& d : p.densities) {
    hash.tag("density " + d.name);
    hash.add(d.density);
    add_start(hash, d.blobs, d.wave, d.grid);
  }
  if (!p.densities.empty()) {
    for (const auto& axis : p.sides)
      for (const Side& side : axis) hash.add(side.of);
    for (const Source& s : p.sources) hash.add(s.of);
  }
  for (const ParticleSet& set : p.particles) {
    hash.tag("particles");
    hash.add(set.count);
    add(hash, set.region);
    hash.add(std::int64_t(set.seed));
    hash.add(set.fall);
    hash.add(int(set.leaving));
  }
  return hash.digits();
}

}  // namespace airlight::scene
