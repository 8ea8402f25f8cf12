// Cost of dropping details by the object's distance (Giroud and Biri 2010, section 4.4, eq. 12): errors, and seams,
// since fog looks different before a near and a far object.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

class WaveletSeams : public Probe {
 public:
  std::string name() const override { return "wavelet_seams"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
