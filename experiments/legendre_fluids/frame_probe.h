// A frame of Legendre fluids from start to end: a step of the fluid, particles that it carries, a picture of its smoke with them in it.
#pragma once
#include "experiments/application/probe.h"
#include "gpu/context.h"

namespace airlight::experiments {

// Everything on the processor.
class LegendreFrame : public Probe {
 public:
  std::string name() const override { return "legendre_frame"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// Fluid, places of particles and light on the device; particles are drawn by the processor and sent up.
class LegendreFrameGpu final : public LegendreFrame {
 public:
  std::string name() const override { return "legendre_frame_gpu"; }
  std::string device() const override { return gpu::Context::name_of_device(); }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
