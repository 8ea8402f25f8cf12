// The variant `galerkin` of methods/legendre_fluids on the device: coefficients live there, in single precision, and so does every step.
//
// An evaluation of the right side is four dispatches: expand.comp takes slabs of one x to Gauss points along y and z, points.comp lines of
// points along x, where products are taken, and back, collect.comp slabs back to coefficients, columns.comp the pressure along x; the rest
// of the pressure is done where the next begins.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "gpu/legendre_fluids/tables.h"
#include "methods/legendre_fluids/confined_fluid.h"

namespace airlight::gpu::legendre_fluids {

using airlight::legendre_fluids::ConfinedOptions;
using airlight::legendre_fluids::Fluid;
using airlight::legendre_fluids::Material;

constexpr int most_regions = 64;  // of sources, and of forces: uniforms

// Regions that sources fill and forces push, by their coefficients.
struct Regions {
  std::vector<Array> sources, pushes;
};

// Influences on the fluid before it moves in a step; after it they act in the opposite order.
struct Acting {
  double fades = 1;  // what decay leaves
  // For the carried fields, in their order: amounts added by sources, [source][field]; push per unit of
  // a field [half sizes per second].
  std::vector<std::vector<double>> sources;
  std::vector<Vec3> weights;
  std::vector<Vec3> pushes;  // by force [half sizes per second]
};
using StepForces = std::array<Acting, 2>;

class FluidOnDevice {
 public:
  // With the coefficients of a fluid: what of Fluid::carried() is not empty is carried. 2 <= n <= most_coefficients. Throws
  // Unavailable as Buffer and Program do.
  FluidOnDevice(Context&, Fluid&, const Material&, const ConfinedOptions&, const Regions& = {});

  // By dt [s]. Runge-Kutta divides it as on the CPU. One wait, for the greatest speed and whether all is finite, and one more for each
  // part where it is divided. Throws scene::Unstable, and leaves the state as it was.
  void step(double dt, const StepForces& = {});
  double substeps() const { return substeps_; }  // of Runge-Kutta so far

  // Into a fluid that was made alike, and from it.
  void download(Fluid&) const;
  void upload(Fluid&);

  // Current coefficients, with the layout of fields.glsl. The buffer changes with every step.
  const Buffer& state() const { return *states_[current_]; }
  // Coefficients before the last step.
  const Buffer& before() const { return *states_[1 - current_]; }
  // Definitions for shaders that read the coefficients.
  const Definitions& definitions() const { return definitions_; }
  // Indices into Fluid::carried() of the fields that are stored after the velocity's components.
  const std::vector<std::size_t>& carried() const { return carried_; }

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
  void points(bool measures);
  void collect(Fields, ComesFrom);
  void columns(Fields, bool diffuses, double dt = 0);
  void spread_modes_back(Fields, double dt);
  void set(const Acting&);
  bool pushes(const Acting&) const;
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

  Context& context_;
  ConfinedSpace space_;
  Material material_;
  ConfinedOptions options_;
  bool moves_;
  std::vector<std::size_t> carried_;  // of Fluid::carried(), by field
  int velocities_, fields_, slab_group_;
  bool divides_ = false;  // the last step was divided
  std::size_t slab_, size_, lines_;
  double substeps_ = 0;
  std::unique_ptr<Buffer> tables_, regions_, states_[2], rates_, pressure_, spread_, gathered_, status_;
  int current_ = 0;  // of the states
  Definitions definitions_;
  Program *expand_, *points_, *collect_, *columns_;
};

}  // namespace airlight::gpu::legendre_fluids
