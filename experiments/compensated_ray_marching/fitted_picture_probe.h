// Error of pictures when smoke is converted to Gaussians and a quantised residual.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

class FittedPicture : public Probe {
 public:
  std::string name() const override { return "fitted_picture"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
