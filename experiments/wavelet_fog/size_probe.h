// Cost of a picture against the size of the map: where passing empty blocks, coarse blocks and tables from the eye pay.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

class WaveletMapSize : public Probe {
 public:
  std::string name() const override { return "wavelet_map_size"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
