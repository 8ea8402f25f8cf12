// The variant `galerkin` of methods/legendre_fluids on the device: coefficients live there, in single precision, and so does every step.
//
// An evaluation of the right side is four dispatches: expand.comp takes slabs of one x to Gauss points along y and z, points.comp lines of
// points along x, where products are taken, and back, collect.comp slabs back to coefficients, columns.comp the pressure along x; the rest
// of the pressure is done where the next begins. Where air comes in, inflow.comp stands between the second and the third.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "gpu/legendre_fluids/fluid.h"
#include "gpu/legendre_fluids/tables.h"
#include "methods/legendre_fluids/confined_fluid.h"

namespace airlight::gpu::legendre_fluids {

using airlight::legendre_fluids::ConfinedOptions;
using airlight::legendre_fluids::Wind;

class ConfinedFluidOnDevice final : public FluidOnDevice {
 public:
  // With the coefficients of a fluid. 2 <= n <= most_coefficients; the wind is at most linear in space. Throws Unavailable as Buffer and
  // Program do.
  ConfinedFluidOnDevice(Context&, Fluid&, const Material&, const ConfinedOptions&, const Regions& = {},
                        const std::optional<Wind>& = {});

  // Runge-Kutta divides the step as on the CPU. One wait, for the greatest speed and whether all is finite, and one more for each part
  // where it is divided.
  void step(double dt, const StepForces& = {}) override;
  void download(Fluid&) const override;
  void upload(Fluid&) override;
  std::map<std::string, double> counters() const override { return {{"Runge-Kutta steps", substeps_}}; }
  double substeps() const { return substeps_; }  // of Runge-Kutta so far
  bool blows() const override { return wind_.has_value(); }

  // Parts of a step: the nearest velocity without divergence; diffusion of all over a time [s], divergence left; the rates of advection
  // before projection, into a fluid that was made alike.
  void project();
  void diffuse(double dt);
  void advect(Fluid& rates);

 private:
  struct Fields {
    int first, count;
  };
  void bind();
  void take(const std::vector<float>& fields, Fluid&) const;
  void set(Program&, Fields);
  void expand(Fields, GoesOn, bool adds, int stage, double dt, bool begins = false, bool ends = false);
  void points(bool measures, double time);
  void collect(Fields, ComesFrom);
  void columns(Fields, bool diffuses, double dt = 0);
  void spread_modes_back(Fields, double dt);
  void set(const Acting&);
  void push();
  int run(double dt, const StepForces&, bool looks);
  struct Status {
    double speed;  // greatest, of the last points() that measured [half sizes per second]
    bool finite;
  };
  Status look() const;  // waits
  int steps_in(double dt, const Status&) const;
  Fields moving() const { return {moves_ ? 0 : velocities_, fields_ - (moves_ ? 0 : velocities_)}; }
  Fields diffusing() const;

  LinearWind wind_at(double time) const override;

  ConfinedSpace space_;
  Material material_;
  ConfinedOptions options_;
  std::optional<Wind> wind_;
  LinearWind calm_;  // the wind without its gust
  bool moves_;
  int velocities_, fields_, slab_group_;
  bool divides_ = false;  // the last step was divided
  std::size_t slab_, size_, lines_;
  double substeps_ = 0;
  std::unique_ptr<Buffer> tables_, regions_, rates_, pressure_, spread_, gathered_, status_;
  Program *expand_, *points_, *inflow_ = nullptr, *collect_, *columns_;
};

}  // namespace airlight::gpu::legendre_fluids
