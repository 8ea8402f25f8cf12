// Pictures of smoke from frame to frame, under light that turns: how much of what changes between two of them is error.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

class SmokeFlicker : public Probe {
 public:
  std::string name() const override { return "smoke_flicker"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
