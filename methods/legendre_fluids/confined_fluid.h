// The variant `galerkin`: velocities of a ConfinedSpace, the projection inside the right side, exact diffusion. Advection keeps energy, but for
// the order of the time step.
#pragma once
#include <array>
#include <optional>

#include "methods/legendre_fluids/fluid.h"

namespace airlight::legendre_fluids {

enum class TimeStep { runge_kutta, exponential, cayley };

struct ConfinedOptions {
  TimeStep time_step = TimeStep::runge_kutta;
  int krylov = 30;           // vectors of a Krylov space at most
  double tolerance = 1e-10;  // of its error, relative
  // Coefficient k of an axis times exp(-rate (k / (n-1))^order dt) [1/s].
  double filter_velocity = 0, filter_carried = 0, filter_order = 8;
};

// How many steps of Runge-Kutta dt [s] takes where the greatest speed is `speed` [half sizes per second], and whether air comes in. Throws
// scene::Unstable above 1e6, and where the speed is no number.
int runge_kutta_steps(double dt, int n, double speed, bool air_comes_in);

using BySide = std::array<std::array<double, 2>, 3>;  // [axis][low, high]

// Wind through the box: a velocity that is not confined, and what its air brings along.
struct Wind {
  VelocityFunction velocity;        // polynomial of degree below n
  bool added = false;               // to a confined velocity; else it is all there is
  BySide density{}, temperature{};  // that come in
};

class ConfinedFluid : public Fluid {
 public:
  ConfinedFluid(int dimensions, int n, const Vec3& half, const Material&, const ConfinedOptions&,
                std::optional<Wind> = {});

  void begin(const VelocityFunction&) override;
  void advance(double dt) override;
  void push(const Components& change) override;
  void finish(double dt) override { filter(dt); }
  Components at_points() const override;
  Array sampled(int component, const Components& positions) const override;
  Array sampled_slope(int component, int axis, const Components& positions) const override;
  double at(int component, const Vec3& x) const override;
  Array history() const override { return last_rate_; }
  void set_history(const Array& rate) override { last_rate_ = rate; }
  std::map<std::string, double> counters() const override;

 private:
  Components carrying(const Array& u) const;  // at the points: the velocity u and the wind
  Array carried_rate(const Components& w, const Array& r, const BySide& incoming) const;
  void diffuse(double dt);
  void advect_by_runge_kutta(double dt);
  void advect_by_krylov(double dt);
  Array krylov(const Array& y, double dt, const SkewOperator&);
  void filter(double dt);
  bool confined() const { return !wind_ || wind_->added; }

  ConfinedOptions options_;
  std::optional<Wind> wind_;
  Components wind_at_points_;
  std::array<std::array<Array, 2>, 3> wind_on_sides_;  // along the axis of the side
  Array last_rate_;  // of advection in the last step of a Krylov method; empty before the first
  double substeps_ = 0, vectors_ = 0, greatest_estimate_ = 0, filtered_ = 0;
};

}  // namespace airlight::legendre_fluids
