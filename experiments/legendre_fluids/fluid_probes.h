// Legendre fluids as probes: what its parts cost, where its variants stay bounded, which smoke a polynomial of a box can hold.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

// Time of a part of a step in three dimensions over coefficients, one thread, and its exponent.
class LegendreCost : public Probe {
 public:
  std::string name() const override { return "legendre_cost"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  std::vector<std::string> speeds() const override { return {"exponent", "exponent_of_coefficients"}; }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// Figures 10 and 11: time of a step over coefficients against that of Stable Fluids over cells.
class LegendreSpeed : public Probe {
 public:
  std::string name() const override { return "legendre_speed"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  std::vector<std::string> speeds() const override { return figures(); }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// After how many steps the energy of a swirl that nothing drives has grown tenfold, over step and viscosity.
class LegendreStability : public Probe {
 public:
  std::string name() const override { return "legendre_stability"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// Error of a medium as a Legendre box. Input: a scene with a medium.
class LegendreSmoke : public Probe {
 public:
  std::string name() const override { return "legendre_smoke"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
