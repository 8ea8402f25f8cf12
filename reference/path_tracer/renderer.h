// The unbiased reference as a renderer of scenes: "path_tracer".
#pragma once
#include "scene/renderer.h"

namespace airlight::path_tracer {

class PathTracer : public scene::Renderer {
 public:
  std::string name() const override { return "path_tracer"; }
  std::string about() const override;
  bool monte_carlo() const override { return true; }
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> supports(const scene::Scene&, const scene::Settings&) const override;

 private:
  std::unique_ptr<scene::Prepared> prepare_supported(std::shared_ptr<const scene::Scene>, const scene::Settings&,
                                                     const scene::Execution&) const override;
};

}  // namespace airlight::path_tracer
