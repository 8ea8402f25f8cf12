#include "gpu/legendre_fluids/legendre_fluids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gpu/legendre_fluids/confined_fluid.h"
#include "gpu/legendre_fluids/flow_particles.h"
#include "gpu/legendre_fluids/paper_fluid.h"
#include "methods/legendre_fluids/legendre_flow.h"
#include "methods/legendre_fluids/legendre_fluids.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using airlight::legendre_fluids::ConfinedFluid;
using airlight::legendre_fluids::FlowOptions;
using airlight::legendre_fluids::LegendreFlow;
using airlight::legendre_fluids::Mixing;
using scene::FlowProblem;
// Makes the device's copy of a fluid.
using ToDevice = std::function<std::unique_ptr<FluidOnDevice>(Fluid&, const Regions&)>;

class LegendreFlowGpu final : public LegendreFlow {
 public:
  LegendreFlowGpu(std::shared_ptr<const FlowProblem> problem, std::unique_ptr<Fluid> fluid, int cells, Mixing mixing,
                  const ToDevice& to_device)
      : LegendreFlow(std::move(problem), std::move(fluid), cells, mixing),
        device_(to_device(*fluid_, {source_, push_})) {}

  // Not LegendreFlow::add: shaders have room for the problem's forces alone.
  void add(const scene::Push& push) override { scene::Flow::add(push); }  // NOLINT(bugprone-parent-virtual-call)
  std::map<std::string, double> counters() const override {
    auto counters = LegendreFlow::counters();
    for (const auto& [name, value] : device_->counters()) counters[name] = value;
    counters.erase("energy filtered");  // nobody looks
    return counters;
  }
  void restore(const std::string& state) override {
    LegendreFlow::restore(state);
    here_ = true;
    LegendreFlow::settle();
    device_->upload(*fluid_);
  }

  std::unique_ptr<scene::ParticleMover> particle_mover(const scene::ParticlePlaces& places) const override {
    return std::make_unique<ParticlesOnDevice>(Context::get(), *device_, *p_, places);
  }

  std::optional<DensityOnDevice> density_on_device(int density) const {
    const auto& carried = device_->carried();
    const auto at = std::find(carried.begin(), carried.end(), std::size_t(density));
    if (p_->dimensions != 3 || mixing_ != Mixing::densities || density < 0 ||
        std::size_t(density) > p_->densities.size() || at == carried.end())
      return {};
    return DensityOnDevice{device_->state(), std::size_t(3 + (at - carried.begin())), fluid_->space().n(), p_->box};
  }

 private:
  void move(double dt) override {
    timed("steps on the device", [&] { device_->step(dt, forces(dt)); });
    here_ = false;
  }
  Fluid& now() const override {
    if (!here_) {
      device_->download(*fluid_);
      here_ = true;
      LegendreFlow::settle();
    }
    return *fluid_;
  }
  void settle() const override {
    if (here_) LegendreFlow::settle();
  }

  StepForces forces(double dt) const {
    const auto acting = this->acting(dt);
    return {on_device(acting[0]), on_device(acting[1]), time()};
  }
  gpu::legendre_fluids::Acting on_device(const Acting& acting) const {
    gpu::legendre_fluids::Acting f;
    const std::vector<double> seconds = source_seconds(acting.sources),
                              push_seconds = this->push_seconds(acting.pushes);
    const std::size_t temperature = p_->densities.size() + 1;  // of Fluid::carried()
    for (const std::size_t which : device_->carried()) {
      // The share of an albedo neither weighs nor decays.
      const bool is_share = mixing_ == Mixing::albedo && which == 1;
      const double lifts = which == temperature ? -p_->expansion : is_share ? 0 : p_->weight;
      f.fades.push_back(is_share ? 1 : fluid_->faded(p_->decay * acting.decay));
      f.weights.push_back(acting.pushes.length() * lifts * p_->gravity.cwiseQuotient(box_.half));
    }
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      const scene::Source& s = p_->sources[i];
      f.sources.emplace_back();
      for (const std::size_t which : device_->carried())
        f.sources[i].push_back(which == temperature         ? seconds[i] * s.temperature_rate
                               : which == std::size_t(s.of) ? seconds[i] * s.density_rate
                                                            : 0);
    }
    for (std::size_t i = 0; i < push_seconds.size(); ++i)
      f.pushes.push_back(push_seconds[i] * pushes_[i].acceleration.cwiseQuotient(box_.half));
    return f;
  }

  std::unique_ptr<FluidOnDevice> device_;
  mutable bool here_ = true;  // *fluid_ has the coefficients of now
};

}  // namespace

std::optional<DensityOnDevice> density_on_device(const scene::Flow& flow, int density) {
  const auto* here = dynamic_cast<const LegendreFlowGpu*>(&flow);
  return here ? here->density_on_device(density) : std::nullopt;
}

std::string LegendreFluids::about() const {
  return "legendre_fluids in compute shaders: galerkin in single precision, the paper's variants in double (Gupta and Narasimhan 2007)";
}

std::vector<scene::SettingSpec> LegendreFluids::settings() const {
  return airlight::legendre_fluids::LegendreFluids().settings();
}

std::vector<std::string> LegendreFluids::supports(const FlowProblem& problem, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::legendre_fluids::LegendreFluids().supports(problem, settings);
  const FlowOptions o = airlight::legendre_fluids::read_flow_options(settings);
  const double coefficients = std::pow(double(o.n), problem.dimensions);
  if (o.variant == FlowOptions::Variant::galerkin && (o.n < 2 || o.n > most_coefficients))
    reasons.push_back(fmt::format("n = {}: shaders take 2 to {} coefficients along an axis", o.n, most_coefficients));
  if (o.variant == FlowOptions::Variant::paper_repaired && coefficients > most_paper_coefficients)
    reasons.push_back(fmt::format("paper_repaired with {:.0f} coefficients of a field: shaders take {}", coefficients,
                                  most_paper_coefficients));
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
  const FlowOptions o = airlight::legendre_fluids::read_flow_options(settings);
  std::unique_ptr<Fluid> fluid;
  ToDevice to_device;
  if (o.variant == FlowOptions::Variant::galerkin) {
    const auto wind = airlight::legendre_fluids::wind_through(problem, box);
    fluid = std::make_unique<ConfinedFluid>(box.dimensions, o.n, box.half, material, o.confined, wind);
    to_device = [&, wind](Fluid& f, const Regions& regions) -> std::unique_ptr<FluidOnDevice> {
      return std::make_unique<ConfinedFluidOnDevice>(Context::get(), f, material, o.confined, regions, wind);
    };
  } else {
    fluid = std::make_unique<PaperFluid>(box.dimensions, o.n, box.half, material, o.truncation,
                                         o.variant == FlowOptions::Variant::paper_repaired);
    to_device = [&](Fluid& f, const Regions& regions) -> std::unique_ptr<FluidOnDevice> {
      return std::make_unique<PaperFluidOnDevice>(Context::get(), dynamic_cast<PaperFluid&>(f), material, regions);
    };
  }
  return std::make_unique<LegendreFlowGpu>(std::move(problem), std::move(fluid), o.cells, o.mixing, to_device);
}

}  // namespace airlight::gpu::legendre_fluids
