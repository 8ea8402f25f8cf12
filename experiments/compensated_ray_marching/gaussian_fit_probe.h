// How well and how fast Gaussians fit smoke: one frame, or a sequence.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

class GaussianFitProbe : public Probe {
 public:
  std::string name() const override { return "gaussian_fit"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
