// Time and error of a picture of smoke, as Legendre coefficients and as voxels of the same smoke: what Gupta and Narasimhan 2007 compare in
// Figures 10 and 11.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

class LegendreRendering final : public Probe {
 public:
  std::string name() const override { return "legendre_rendering"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  std::vector<std::string> speeds() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
