// Look-ups in a residual on the device, in bricks and in hashes: what a march there pays for each sample.
#pragma once
#include "experiments/application/probe.h"
#include "gpu/context.h"

namespace airlight::experiments {

class ResidualDecode : public Probe {
 public:
  std::string name() const override { return "residual_decode_gpu"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  std::string device() const override { return gpu::Context::name_of_device(); }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
