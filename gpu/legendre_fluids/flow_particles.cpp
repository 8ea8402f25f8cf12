#include "gpu/legendre_fluids/flow_particles.h"

namespace airlight::gpu::legendre_fluids {
namespace {

constexpr int group = 32;  // particles

std::vector<double> numbers(const scene::ParticlePlaces& places) {
  std::vector<double> all;
  for (std::size_t s = 0; s < places.positions.size(); ++s)
    for (std::size_t i = 0; i < places.positions[s].size(); ++i) {
      const Point3& x = places.positions[s][i];
      all.insert(all.end(), {x[0], x[1], x[2], places.times[s][i]});
    }
  return all;
}

}  // namespace

ParticlesOnDevice::ParticlesOnDevice(Context& context, const FluidOnDevice& fluid, const scene::FlowProblem& problem,
                                     const scene::ParticlePlaces& places)
    : context_(context),
      fluid_(fluid),
      problem_(problem),
      program_(program(context, "particles", group, 1, fluid.definitions())) {
  const Use use(context);
  particles_ = std::make_unique<Buffer>(context, "particles", numbers(places));
}

void ParticlesOnDevice::step(double dt) {
  const Use use(context_);
  Program& p = program_;
  fluid_.before().bind(at::start);
  fluid_.state().bind(at::state);
  particles_->bind(at::particles);
  p.set("loop_count", 3);
  p.set_double("dt", dt);
  p.set_double("low", problem_.box.lo);
  p.set_double("size", problem_.box.size());
  if (fluid_.blows()) {
    p.set("winds[0]", fluid_.wind_before().middle);
    p.set("winds[1]", fluid_.wind().middle);
    p.set("wind_slopes", fluid_.wind().slopes);
  }
  int first = 0;
  for (const scene::ParticleSet& set : problem_.particles) {
    p.set("first", first);
    p.set("count", set.count);
    p.set("leaving", int(set.leaving));
    p.set("seed_low", double(set.seed & 0xffffu));
    p.set("seed_high", double(set.seed >> 16));
    p.set_double("fall", set.fall);
    p.dispatch(set.count);
    first += set.count;
  }
  context_.check("a step of particles");
}

void ParticlesOnDevice::read(scene::ParticlePlaces& places) const {
  const Use use(context_);
  const std::vector<double> all = particles_->download<double>();
  std::size_t at = 0;
  for (std::size_t s = 0; s < places.positions.size(); ++s)
    for (std::size_t i = 0; i < places.positions[s].size(); ++i, at += 4) {
      places.positions[s][i] = Point3(all[at], all[at + 1], all[at + 2]);
      places.times[s][i] = all[at + 3];
    }
}

void ParticlesOnDevice::write(const scene::ParticlePlaces& places) {
  const Use use(context_);
  particles_->upload(numbers(places));
}

}  // namespace airlight::gpu::legendre_fluids
