// How close fogshop comes to the machine: kernel evaluations per second in whole pictures against a bare loop of the same
// arithmetic.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

// Input: a scene with point lights and grey fog of Gaussians. Settings: those of fogshop (variants `paper`, and S with
// light maps), runs, clock. Rates in millions per second.
class KernelRate : public Probe {
 public:
  std::string name() const override { return "kernel_rate"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  std::vector<std::string> speeds() const override {
    return {"evaluations", "bare_loop", "share", "erf_calls", "bare_loop_of_erf", "share_of_erf"};
  }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
