// Size, build time and look-up time of the stores that can hold a quantised residual.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

class ResidualStores : public Probe {
 public:
  std::string name() const override { return "residual_stores"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
