// The variants `paper` and `paper_repaired` of methods/legendre_fluids on the device, in double precision: the equations without walls gain
// energy, and rounding with it.
//
// paper_fluid_begin.comp adds sources and takes the velocity to the points, paper_fluid_advect.comp sums the series of equation 14,
// paper_fluid_diffuse.comp and paper_fluid_end.comp do the rest of a step. A work group does what a field needs. Only the device knows how
// many terms the series takes: a step dispatches a quarter more than the last one needed. Where they are too few, the rest of the step does
// nothing, and both are dispatched again.
#pragma once
#include "gpu/legendre_fluids/fluid.h"
#include "methods/legendre_fluids/paper_fluid.h"

namespace airlight::gpu::legendre_fluids {

using airlight::legendre_fluids::PaperFluid;

// Coefficients of a field: with more, a term would meet llvmpipe's limit on loops.
constexpr int most_paper_coefficients = 4096;

class PaperFluidOnDevice final : public FluidOnDevice {
 public:
  // With the coefficients and the operators of a fluid. Throws Unavailable as Buffer and Program do.
  PaperFluidOnDevice(Context&, PaperFluid&, const Material&, const Regions& = {});

  // One wait, and one more each time the series needs more terms than were dispatched.
  void step(double dt, const StepForces& = {}) override;
  void download(Fluid&) const override;
  void upload(Fluid&) override;
  std::map<std::string, double> counters() const override { return {}; }

 private:
  struct Status {
    std::vector<double> most,
        squares;   // by component: the greatest |u| along it; the sum of its squared coefficients at first
    double steps;  // of the series, of the field that took most
    bool done, lost, lost_at_end;
    double advected, pushed, last;  // energies
  };
  void lay_out(const PaperFluid&, const Regions&);
  void set_factors(double dt);
  void bind();
  void set(const StepForces&);
  void advect(double dt, int steps);
  void end(double dt, const StepForces&);
  Status look() const;  // waits
  void require_tame(const Status&, double dt) const;

  Material material_;
  bool repaired_;
  int velocities_, fields_, n_;
  std::size_t size_;
  Vec3 half_;
  airlight::legendre_fluids::ConfinedSpace space_;
  std::optional<airlight::legendre_fluids::ConfinedSpace> confined_;
  Eigen::MatrixXd to_wall_, to_free_;
  std::vector<double> tables_;
  std::size_t factors_at_ = 0;  // of exact diffusion, in the tables
  double factors_dt_ = 0;
  int steps_ = 32;    // of the series, that a step dispatches
  int together_ = 1;  // of a dispatch
  int lanes_ = 0;     // of a work group
  std::unique_ptr<Buffer> table_, doubles_[2], work_, speeds_, status_;
  Program *begin_, *advect_, *diffuse_, *end_;
};

}  // namespace airlight::gpu::legendre_fluids
