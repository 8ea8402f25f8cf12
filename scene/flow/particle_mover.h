// Interface to move the particles of a flow on the device where the flow is computed.
#pragma once
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

// State of all particles, ordered by set as in the problem.
struct ParticlePlaces {
  std::vector<std::vector<Point3>> positions;  // [m]
  std::vector<std::vector<double>> times;      // how often it has been drawn anew
};

class ParticleMover {
 public:
  virtual ~ParticleMover() = default;
  // Over the last step of the flow that made this, of dt [s], as FlowParticles::step.
  virtual void step(double dt) = 0;
  virtual void read(ParticlePlaces&) const = 0;  // waits for the device
  virtual void write(const ParticlePlaces&) = 0;
};

}  // namespace airlight::scene
