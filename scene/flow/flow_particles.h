// Particles without weight that a flow carries: snow flakes, confetti.
#pragma once
#include <string>
#include <vector>

#include "scene/flow/flow.h"

namespace airlight::scene {

// dx/dt = u(x, t) + fall, by the classical Runge-Kutta method of fourth order, u linear in time over a step. A
// particle's path depends on the flow, its set and its number alone: threads and order do not matter.
class FlowParticles {
 public:
  // At their first places. Throws Error (the problem's file) where a region has no room for them.
  explicit FlowParticles(const FlowProblem&);

  bool empty() const { return here_.positions.empty(); }
  // Over the step of dt [s] between two states of one flow.
  void step(const Flow& before, const Flow& after, double dt, const Execution&);

  // True: from now on they lie where the flow does, and step(dt) moves them over its last step; what is asked of them comes down once.
  bool ride(const Flow&);
  void step(double dt);

  // By set, as in the problem.
  const std::vector<std::vector<Point3>>& positions() const { return now().positions; }
  // The text that scenes read: one row with set and position for each particle, exact.
  std::string csv() const;

  // All that the next step depends on, and back. Throws Error.
  std::string state() const;
  void restore(const std::string& state);

 private:
  void move(const Flow& before, const Flow& after, double dt, std::size_t set, std::size_t begin, std::size_t end);
  const ParticlePlaces& now() const;
  void let_leave(const ParticleSet&, std::size_t i, Point3&, double& times) const;

  Box box_;
  int dimensions_;
  std::vector<ParticleSet> sets_;
  mutable ParticlePlaces here_;
  std::unique_ptr<ParticleMover> mover_;  // null: they are moved here
  mutable bool moved_ = false;            // it has moved them, and here_ is of before
};

}  // namespace airlight::scene
