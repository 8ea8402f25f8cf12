// Legendre fluids: Gupta and Narasimhan, "Legendre Fluids: A Unified Framework for Analytic Reduced Space Modeling and Rendering of
// Participating Media" (SCA 2007), section 5. A box of n coefficients along each axis, in two or three dimensions.
#pragma once
#include "methods/legendre_fluids/confined_fluid.h"
#include "methods/legendre_fluids/legendre_flow.h"
#include "methods/legendre_fluids/paper_operators.h"
#include "methods/legendre_fluids/reference_box.h"
#include "scene/flow/flow.h"

namespace airlight::legendre_fluids {

// Whether anything goes through the sides of the box.
bool air_comes_in(const scene::FlowProblem&);
// Flow through the sides, at most linear in space, and the quantities that it carries in; nothing if no air comes in.
std::optional<Wind> wind_through(const std::shared_ptr<const scene::FlowProblem>&, const ReferenceBox&);

struct FlowOptions {
  enum class Variant { galerkin, paper, paper_repaired } variant = Variant::galerkin;
  int n = 8;
  double dt = 0;  // [s], the longest step; 0: a frame
  Truncation truncation = Truncation::chebyshev;
  Mixing mixing = Mixing::densities;
  ConfinedOptions confined;  // of galerkin
  int cells = 64;
};
FlowOptions read_flow_options(const scene::Settings&);

class LegendreFluids : public scene::Solver {
 public:
  std::string name() const override { return "legendre_fluids"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::FlowProblem&, const scene::Settings&) const override;
  int steps_per_frame(const scene::FlowProblem&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Flow> start_supported(std::shared_ptr<const scene::FlowProblem>, const scene::Settings&,
                                               const scene::Execution&) const override;
};

}  // namespace airlight::legendre_fluids
