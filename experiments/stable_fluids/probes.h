// Stable Fluids as probes: a flow that is known, where it stays bounded, and what its stages cost.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

// A box whose lid moves against spectral solutions and Ghia et al. 1982. Input: a file of oracle vectors with
// fluid-cavity-regular, fluid-cavity-lid and fluid-ghia-u.
class CavityProbe : public Probe {
 public:
  std::string name() const override { return "cavity"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// How much a stirred flow that nothing drives grows, over step and viscosity.
class FlowStability : public Probe {
 public:
  std::string name() const override { return "flow_stability"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// One projection, by each solver for the pressure.
class PressureSolvers : public Probe {
 public:
  std::string name() const override { return "pressure_solvers"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  std::vector<std::string> speeds() const override { return {"of_transforms"}; }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
