#include "gpu/legendre_fluids/legendre_fluids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/legendre_fluids/confined_fluid.h"
#include "gpu/legendre_fluids/flow_particles.h"
#include "methods/legendre_fluids/legendre_flow.h"
#include "methods/legendre_fluids/legendre_fluids.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using airlight::legendre_fluids::ConfinedFluid;
using airlight::legendre_fluids::ConfinedOptions;
using airlight::legendre_fluids::Fluid;
using airlight::legendre_fluids::LegendreFlow;
using airlight::legendre_fluids::Material;
using scene::FlowProblem;

class LegendreFlowGpu final : public LegendreFlow {
 public:
  LegendreFlowGpu(std::shared_ptr<const FlowProblem> problem, const Material& material, const ConfinedOptions& options,
                  std::unique_ptr<Fluid> fluid, int cells)
      : LegendreFlow(std::move(problem), std::move(fluid), cells, airlight::legendre_fluids::Mixing::densities),
        device_(Context::get(), *fluid_, material, options, {source_, push_}) {}

  std::map<std::string, double> counters() const override {
    auto counters = LegendreFlow::counters();
    counters["Runge-Kutta steps"] = device_.substeps();
    counters.erase("energy filtered");  // nobody looks
    return counters;
  }
  void restore(const std::string& state) override {
    LegendreFlow::restore(state);
    device_.upload(*fluid_);
    here_ = true;
  }

  std::unique_ptr<scene::ParticleMover> particle_mover(const scene::ParticlePlaces& places) const override {
    return std::make_unique<ParticlesOnDevice>(Context::get(), device_, *p_, places);
  }

  std::optional<DensityOnDevice> density_on_device(int density) const {
    const auto& carried = device_.carried();
    const auto at = std::find(carried.begin(), carried.end(), std::size_t(density));
    if (p_->dimensions != 3 || density < 0 || std::size_t(density) > p_->densities.size() || at == carried.end())
      return {};
    return DensityOnDevice{device_.state(), std::size_t(3 + (at - carried.begin())), fluid_->space().n(), p_->box};
  }

 private:
  void move(double dt) override {
    timed("steps on the device", [&] { device_.step(dt, forces(dt)); });
    here_ = false;
  }
  Fluid& now() const override {
    if (!here_) device_.download(*fluid_);
    here_ = true;
    return *fluid_;
  }

  StepForces forces(double dt) const {
    const auto acting = this->acting(dt);
    return {on_device(acting[0]), on_device(acting[1])};
  }
  gpu::legendre_fluids::Acting on_device(const Acting& acting) const {
    gpu::legendre_fluids::Acting f;
    const std::vector<double> seconds = source_seconds(acting.sources),
                              push_seconds = this->push_seconds(acting.pushes);
    const std::size_t temperature = p_->densities.size() + 1;  // of Fluid::carried()
    for (const std::size_t which : device_.carried()) {
      const double lifts = which == temperature ? -p_->expansion : p_->weight;
      f.weights.push_back(acting.pushes.length() * lifts * p_->gravity.cwiseQuotient(box_.half));
    }
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      const scene::Source& s = p_->sources[i];
      f.sources.emplace_back();
      for (const std::size_t which : device_.carried())
        f.sources[i].push_back(which == temperature         ? seconds[i] * s.temperature_rate
                               : which == std::size_t(s.of) ? seconds[i] * s.density_rate
                                                            : 0);
    }
    for (std::size_t i = 0; i < push_seconds.size(); ++i)
      f.pushes.push_back(push_seconds[i] * p_->pushes[i].acceleration.cwiseQuotient(box_.half));
    f.fades = fluid_->faded(p_->decay * acting.decay);
    return f;
  }

  FluidOnDevice device_;
  mutable bool here_ = true;  // *fluid_ has the coefficients of now
};

}  // namespace

std::optional<DensityOnDevice> density_on_device(const scene::Flow& flow, int density) {
  const auto* here = dynamic_cast<const LegendreFlowGpu*>(&flow);
  return here ? here->density_on_device(density) : std::nullopt;
}

std::string LegendreFluids::about() const {
  return "legendre_fluids in compute shaders: the variant galerkin in single precision (Gupta and Narasimhan 2007)";
}

std::vector<scene::SettingSpec> LegendreFluids::settings() const {
  return airlight::legendre_fluids::LegendreFluids().settings();
}

std::vector<std::string> LegendreFluids::supports(const FlowProblem& problem, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::legendre_fluids::LegendreFluids().supports(problem, settings);
  const airlight::legendre_fluids::FlowOptions o = airlight::legendre_fluids::read_flow_options(settings);
  if (o.variant != airlight::legendre_fluids::FlowOptions::Variant::galerkin)
    reasons.push_back("variant = " + settings.text("variant") + " is for the CPU: shaders know galerkin");
  if (o.mixing != airlight::legendre_fluids::Mixing::densities)
    reasons.push_back("mixing = albedo is for the CPU: shaders move each density");
  if (o.n < 2 || o.n > most_coefficients)
    reasons.push_back(fmt::format("n = {}: shaders take 2 to {} coefficients along an axis", o.n, most_coefficients));
  if (airlight::legendre_fluids::air_comes_in(problem))
    reasons.push_back("air that comes in through sides: shaders know a closed box");
  if (std::max(problem.sources.size(), problem.pushes.size()) > std::size_t(most_regions))
    reasons.push_back(fmt::format("{} sources and {} forces: shaders have room for {} of each", problem.sources.size(),
                                  problem.pushes.size(), most_regions));
  return reasons;
}

int LegendreFluids::steps_per_frame(const FlowProblem& problem, const scene::Settings& settings) const {
  return airlight::legendre_fluids::LegendreFluids().steps_per_frame(problem, settings);
}

std::unique_ptr<scene::Flow> LegendreFluids::start_supported(std::shared_ptr<const FlowProblem> problem,
                                                             const scene::Settings& settings,
                                                             const scene::Execution&) const {
  const airlight::legendre_fluids::ReferenceBox box(*problem);
  const Material material{problem->viscosity, problem->diffusivity, !problem->velocity_stays};
  const airlight::legendre_fluids::FlowOptions o = airlight::legendre_fluids::read_flow_options(settings);
  auto fluid = std::make_unique<ConfinedFluid>(box.dimensions, o.n, box.half, material, o.confined);
  return std::make_unique<LegendreFlowGpu>(std::move(problem), material, o.confined, std::move(fluid), o.cells);
}

}  // namespace airlight::gpu::legendre_fluids
