// Effect of the misprints in Giroud and Biri 2010: formulas as printed beside the corrected ones.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

// Input: a scene with a fogmap, of degree 0 to 2. errata_probe.cpp says what each is.
class WaveletErrata : public Probe {
 public:
  std::string name() const override { return "wavelet_errata"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
