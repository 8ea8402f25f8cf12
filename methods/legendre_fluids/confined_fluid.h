// The variant `galerkin`: velocities of a ConfinedSpace, the projection inside the right side, exact diffusion. Advection keeps energy, but for
// the order of the time step.
#pragma once
#include <array>
#include <optional>

#include "methods/legendre_fluids/fluid.h"

namespace airlight::legendre_fluids {

struct ConfinedOptions {
  // Coefficient k of an axis times exp(-rate (k / (n-1))^order dt) [1/s].
  double filter_velocity = 0, filter_carried = 0, filter_order = 8;
};

// How many steps of Runge-Kutta dt [s] takes where the greatest speed is `speed` [half sizes per second], and whether air comes in. Throws
// scene::Unstable above 1e6, and where the speed is no number.
int runge_kutta_steps(double dt, int n, double speed, bool air_comes_in);

using BySide = std::array<std::array<double, 2>, 3>;  // [axis][low, high]

// Wind through the box: a velocity that is not confined, and what its air brings along.
struct Wind {
  VelocityFunction velocity;     // polynomial of degree below n
  Vec3 gust = Vec3::Zero();      // half sizes per second, times sin(2 pi frequency t), added
  double frequency = 0;          // [Hz]
  bool added = false;            // to a confined velocity; else it is all there is
  std::vector<BySide> incoming;  // of each of Fluid::carried()
};

class ConfinedFluid : public Fluid {
 public:
  ConfinedFluid(int dimensions, int n, const Vec3& half, const Material&, const ConfinedOptions&,
                std::optional<Wind> = {});

  void begin(const VelocityFunction&) override;
  void advance(double dt) override;
  void push(const Components& change) override;
  void finish(double dt) override { filter(dt); }
  bool halves() const override { return true; }
  Components at_points() const override;
  Array sampled(int component, const Components& positions) const override;
  Array sampled_gradient(int component, int axis, const Components& positions) const override;
  double at(int component, const Vec3& x) const override;
  Array at(int component, const std::vector<Vec3>& x) const override;
  std::map<std::string, double> counters() const override;

 private:
  Components wind_at(double time) const;  // at the points; empty where there is none
  Vec3 gust(double time) const;
  // Adds the inflow with the wind for Fluid::carried()[which].
  void add_inflow(double time, const Array& r, std::size_t which, Array& rate) const;
  void diffuse(double dt);
  Array joined_state();
  Array state_rate(const Array& y);  // of advection
  void advect(double dt);
  void runge_kutta_part(double dt);
  void filter(double dt);
  bool confined() const { return !wind_ || wind_->added; }

  ConfinedOptions options_;
  std::optional<Wind> wind_;
  Components wind_at_points_;
  std::array<std::array<Array, 2>, 3> wind_on_sides_;  // along the axis of the side
  double substeps_ = 0, filtered_ = 0;
};

}  // namespace airlight::legendre_fluids
