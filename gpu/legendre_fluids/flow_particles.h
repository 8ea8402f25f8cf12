// Particles that a fluid on the device carries: they stay there, and move with its steps.
#pragma once
#include "gpu/legendre_fluids/fluid.h"
#include "scene/flow/flow_problem.h"
#include "scene/flow/particle_mover.h"

namespace airlight::gpu::legendre_fluids {

class ParticlesOnDevice final : public scene::ParticleMover {
 public:
  // The fluid and the problem outlive it. Throws Unavailable as Buffer and Program do.
  ParticlesOnDevice(Context&, const FluidOnDevice&, const scene::FlowProblem&, const scene::ParticlePlaces&);
  void step(double dt) override;
  void read(scene::ParticlePlaces&) const override;
  void write(const scene::ParticlePlaces&) override;

 private:
  Context& context_;
  const FluidOnDevice& fluid_;
  const scene::FlowProblem& problem_;
  std::unique_ptr<Buffer> particles_;  // of each its place and how often it has been drawn anew, by set
  Program& program_;
};

}  // namespace airlight::gpu::legendre_fluids
