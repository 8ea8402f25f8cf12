// Input of airlight.glsl: media, the evaluator's numbers, and the term for each light
// (methods/shadow_planes/airlight_term.h).
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/shadow_planes/interface.h"
#include "methods/shadow_planes/options.h"

namespace airlight::gpu::shadow_planes {

class AirlightTermsOnDevice {
 public:
  // The pointer must live on; it may come to point to the same scene with other lights.
  AirlightTermsOnDevice(Context&, const std::shared_ptr<const scene::Scene>&, const airlight::shadow_planes::Options&);

  // All media together, or each alone where they are the paper's; none without a medium.
  int count() const { return int(airlight_terms_.size()); }
  // The paper's medium in a region that an air is, null if it is none.
  const scene::Region* region(int term) const;

  // Definitions for a program that includes airlight.glsl or media.glsl; `term` -1: there is no medium.
  std::map<std::string, std::string> definitions(int light, int term) const;
  // Binds media and the evaluator, sets their uniforms and those of ray.glsl.
  void bind(LinkedProgram&, int light, int term) const;
  void bind_media(LinkedProgram&) const;

 private:
  struct AirlightTerm {
    int medium = 0;
    bool bounded = false, paper = false;
    double mean_distance = 0;
    int degree = 0;
    std::unique_ptr<Buffer> evaluator;
  };
  AirlightTerm make(int medium, bool bounded, bool paper) const;

  Context& context_;
  const std::shared_ptr<const scene::Scene>& scene_;
  airlight::shadow_planes::Options options_;
  bool grey_;
  Buffer media_;
  std::vector<AirlightTerm> airlight_terms_;
};

}  // namespace airlight::gpu::shadow_planes
