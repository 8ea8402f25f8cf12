// Errors and times of the evaluators of shadow planes as probes (evaluator_errors.h).
#pragma once
#include "experiments/application/probe.h"
#include "gpu/context.h"

namespace airlight::experiments::shadow_planes {

// Over extinction and distance of the light, with a map: the stability of an evaluator.
class EvaluatorMap : public Probe {
 public:
  std::string name() const override { return "evaluator_map"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// Errors of the polynomial over random angles.
class EvaluatorAngles : public Probe {
 public:
  std::string name() const override { return "evaluator_angles"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override { return {"median_error", "p99_error"}; }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// Errors of the polynomial over a picture.
class EvaluatorImage : public Probe {
 public:
  std::string name() const override { return "evaluator_image"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override { return {"rms_error"}; }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// Error against time of one evaluation, on the processor.
class EvaluatorTimes : public Probe {
 public:
  std::string name() const override { return "evaluator_times"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override { return {"median_error", "p99_error", "greatest_error"}; }
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

// Errors and times on the device.
class EvaluatorTimesGpu : public EvaluatorTimes {
 public:
  std::string name() const override { return "evaluator_times_gpu"; }
  std::string device() const override { return gpu::Context::name_of_device(); }
  std::vector<scene::SettingSpec> settings() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments::shadow_planes
